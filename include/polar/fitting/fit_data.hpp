// What a model is fitted to: localisations with their covariances, in independent groups.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace polar::fitting {

/// One set of localisations: of a particle, or of all of them.
struct FitData {
  Eigen::Matrix3Xd x_nm;
  std::vector<Eigen::Matrix3d> covariance_nm2;  // as calibrated
  /// Of every localisation, from 0: localisations of one group are not independent (the blinks of one label;
  /// in the superparticle all localisations of a particle).
  std::vector<int> group;
  int groups = 0;
  double background_density = 0;  // of what is spread evenly, nm^-3 (planar nm^-2)
  bool planar = false;

  std::size_t size() const { return covariance_nm2.size(); }
  Eigen::Vector3d centre_nm() const;  // median of every coordinate
  double extent_nm() const;           // median distance from it
};

/// The localisations of every particle of a table whose covariances are calibrated. Blinks are told apart by
/// Mahalanobis distance (`burst_distance`), in an order that `seed` and the particle give. All particles get
/// one background: even over the box of the largest.
std::vector<FitData> particles_of(const smlm::LocalisationTable& table, double burst_distance,
                                  std::uint64_t seed);

/// All particles as one set; every particle is a group.
FitData superparticle_of(const std::vector<FitData>& particles);

/// Some localisations (ascending); groups keep their number.
FitData some_of(const FitData& data, const std::vector<std::uint32_t>& which);

}  // namespace polar::fitting
