// How well a pose can be known at best: the Cramer-Rao bound for a known structure whose emitters are
// not told apart (docs/measures.md, "The limit").
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "polar/core/pose.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// The density of a localisation x (nm, the table's frame) with covariance S under pose T = (R, t):
///   p(x) = (1 - o) / K sum_k N(x; T^-1 s_k, S + label^2 I) + o u
struct StructureModel {
  Eigen::Matrix3Xd site_nm;     // the K sites that this particle shows
  double label_size_nm = 0;     // label
  double outlier_fraction = 0;  // o
  double outlier_density = 0;   // u, nm^-3 (planar nm^-2)
  bool planar = false;          // only x, y and the rotation about z exist
};

/// Fisher information of (w, v) in the left perturbation x -> exp(w) x + v of `structure_from_view`, in
/// the structure's frame (rad^-2, rad^-1 nm^-1, nm^-2): for every covariance the expectation of score x
/// score^T, by `draws` keyed draws from p itself. Frame of the result: the structure's, about its origin.
Eigen::Matrix<double, 6, 6> fisher_information(const StructureModel& model, const Pose& structure_from_view,
                                               const std::vector<smlm::Covariance>& covariance_nm2, int draws,
                                               std::uint64_t seed, std::uint64_t item);

/// Its inverse over what can be known: planar particles have variance 0 where nothing moves. Directions
/// that the data do not determine (information below 1e-12 of the largest) get infinite variance.
Eigen::Matrix<double, 6, 6> cramer_rao_bound(const Eigen::Matrix<double, 6, 6>& information, bool planar);

/// The median angle between pairs of poses whose errors are drawn from these bounds: what compare_poses
/// would report of an estimator at the limit. Degrees.
double pair_median_deg(const std::vector<Eigen::Matrix<double, 6, 6>>& bound, std::uint64_t seed);

}  // namespace polar
