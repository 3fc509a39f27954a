// One localisation of the superparticle against one place that emits: what sites and symmetric units share.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/results/sites.hpp"
#include "smlm/localisation_table.hpp"

namespace polar::results {

/// Root mean square over the axes.
double sigma_nm(const smlm::LocalisationTable& table, std::size_t row);

/// Of every particle that has any, in the order of the particles.
std::vector<std::vector<std::size_t>> rows_of_particles(const smlm::LocalisationTable& table);

/// Density of a localisation at a site, and what it says of the emitter's own place: mean and covariance.
struct Emitter {
  double density = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double variance = 0;  // trace
};

Emitter emitter(bool planar, const Eigen::Matrix3d& covariance, const Eigen::Vector3d& x, const Site& site);

}  // namespace polar::results
