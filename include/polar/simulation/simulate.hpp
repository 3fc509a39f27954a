// The one generator of synthetic data behind tests, benchmarks and demo: copies of a structure as a
// microscope would list them, with the true pose of every copy.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/simulation/structure.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// A value drawn uniformly from [low, high].
using Range = std::array<double, 2>;

struct SimulationOptions {
  std::uint64_t seed = 1;                  // every random choice follows from it
  int particles = 100;                     // number of copies
  std::string orientation = "random_so3";  // random_so3 | in_plane (about z) | identity
  double tilt_std_deg = 0;  // in_plane only: standard deviation of the tilt about x and about y
  std::string sampling =
      "sites";  // sites: labels that blink; points: a number of points drawn from the sites
  double labelling_efficiency = 0.75;      // sites: probability that a site carries a label
  double blinks_mean = 5;                  // sites: mean number of localisations of a label, >= 1
  std::string blinks = "geometric";        // sites: geometric (at least 1) | poisson | fixed
  Range points = {1024, 1024};             // points: number a particle, before cropping
  double label_size_nm = 2;                // standard deviation of the emitter about its site, per axis
  Range sigma_xy_nm = {3, 8};              // lateral uncertainty of a localisation
  Range sigma_y_factor = {1, 1};           // sigma_y over sigma_x
  Range sigma_z_factor = {2, 3};           // sigma_z over sigma_x
  std::string sigma_per = "localisation";  // localisation | particle: how often a sigma is drawn
  double radius_std_nm = 0;     // standard deviation, over particles, of the sites' distance from the axis
  double height_std_nm = 0;     // and of the structure's height along it, stretched evenly
  Range visibility = {1, 1};    // share of a particle that is seen, cut by a plane of random direction
  double outlier_fraction = 0;  // share of all localisations that do not come from the structure
  std::string outliers = "uniform";  // uniform (in a ball of 1.5 radii) | strands (random curves from a site)
  double field_spacing_nm =
      0;                      // > 0: particles stand on a square lattice of this pitch, as in a field of view
  double translation_nm = 0;  // otherwise: uniform shift up to this along each axis
  bool planar = false;        // no z: sites are projected, orientation must be in_plane or identity
  bool cramer_rao = true;     // compute every particle's Cramer-Rao bound
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const SimulationOptions& options);

/// What is known of one simulated particle.
struct SimulatedParticle {
  Pose structure_from_view;  // maps the table's own coordinates (nm) into the structure's frame
  /// Cramer-Rao bound on the covariance of that pose (see cramer_rao.hpp); 0 where not computed.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double visibility = 1;
  double radius_change_nm = 0, height_change_nm = 0;  // of this copy, see radius_std_nm and height_std_nm
};

struct Simulation {
  smlm::LocalisationTable table;
  std::vector<SimulatedParticle> particle;  // in the order of table.particle_names
  std::vector<std::uint8_t> is_outlier;     // one a row of the table
};

/// Draws the table. The same options give the same bits, whatever the number of threads.
Simulation simulate(const Structure& structure, const SimulationOptions& options);

}  // namespace polar
