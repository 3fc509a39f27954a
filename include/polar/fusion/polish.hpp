// The last word on each pose: non-linear least squares with Ceres on the template's responsibilities, and the
// pose's covariance from the curvature of the exact likelihood.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

struct PolishedPose {
  Pose template_from_view;
  /// H^-1 J H^-1, H the observed information (where that is flat or a saddle the Fisher sum), J the sum over
  /// bursts of the outer products of their gradients (P. J. Huber, Proc. 5th Berkeley Symposium 1, 1967;
  /// K.-Y. Liang and S. L. Zeger, Biometrika 73, 1986): right where the localisations of a burst say the
  /// same. H^-1 where bursts are no more than a pose has parameters. For x -> exp(w) x + v applied after
  /// template_from_view, order (w, v).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double temper = 1;  // by which the log likelihood counts its bursts too often: 6 / tr(H^-1 J), at most 1
  double log_likelihood = 0;    // mean per localisation
  double outlier_fraction = 0;  // expected share that the template does not explain
};

/// Poses template_from_view, one a view of `data`, template fixed. Minimises with Ceres, for responsibilities
/// r_jk renewed twice, 1/2 sum_jk r_jk |C_j^(-1/2) (x_j - R^T (mu_k - t))|^2; the outlier class makes
/// it robust.
/// `burst`: of every localisation of every view, in the order of `data`; -1: one of its own. None: all are.
std::vector<PolishedPose> polish(const Mixture& mixture, const FusionData& data,
                                 const std::vector<Pose>& template_from_view,
                                 const std::vector<std::vector<int>>& burst = {});

/// The poses alone, at half the cost.
std::vector<Pose> polished_poses(const Mixture& mixture, const FusionData& data,
                                 const std::vector<Pose>& template_from_view);

}  // namespace polar
