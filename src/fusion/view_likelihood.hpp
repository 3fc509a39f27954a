// The log likelihood of a view under the template and its derivatives with respect to the pose.
#pragma once

#include <Eigen/Core>

#include "blocked_mixture.hpp"
#include "localisations.hpp"

namespace polar {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// sum_j ln p(x_j), natural units.
double log_likelihood(ViewFrame& frame, const KernelLocalisations& view, const Pose& view_from_template,
                      float background, const float* weight = nullptr);

/// Expected share of the localisations that belong to the outlier class.
double outlier_share(ViewFrame& frame, const KernelLocalisations& view, const Pose& view_from_template,
                     float background, const float* weight = nullptr);

/// Derivatives for the perturbation exp(w) x + v applied after view_from_template (frame of the view),
/// order (w, v).
struct PoseDerivatives {
  double log_likelihood = 0;
  Vector6 gradient = Vector6::Zero();
  Matrix6 fisher = Matrix6::Zero();    // sum over localisations of score x score^T
  Matrix6 majorant = Matrix6::Zero();  // curvature of the EM surrogate: responsibilities held fixed
};
PoseDerivatives pose_derivatives(ViewFrame& frame, const KernelLocalisations& view,
                                 const Pose& view_from_template, float background,
                                 const float* weight = nullptr);

struct RefinedPose {
  Pose view_from_template;
  double log_likelihood = 0;
  int evaluations = 0;
};

/// Levenberg-Marquardt on the pose, template fixed; never returns a worse pose than it was given.
RefinedPose refine_pose(ViewFrame& frame, const KernelLocalisations& view, const Pose& start,
                        float background, bool planar, int max_evaluations, const float* weight = nullptr);

/// exp(step) applied after view_from_template.
Pose perturbed(const Pose& view_from_template, const Vector6& step);

}  // namespace polar
