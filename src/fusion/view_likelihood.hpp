// The log likelihood of a view under the template and its derivatives with respect to the pose.
#pragma once

#include <Eigen/Core>

#include "blocked_mixture.hpp"
#include "localisations.hpp"
#include "polar/fusion/cuts.hpp"

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

/// A plane that cuts the view: what lies beyond normal . x = offset (frame of the view) it does not show. The
/// log likelihood gains -worth ln(share of the centres' weight on this side).
struct ViewCut {
  Eigen::Vector3d normal;
  double offset = 0;
  double worth = 0;
};
/// The likeliest at a pose.
ViewCut likeliest_cut(const CutTable& cuts, const ViewReach& reach, const Pose& template_from_view,
                      std::size_t localisations);
/// Adds the gain and its derivatives.
void add_cut(ViewFrame& frame, const Pose& view_from_template, const ViewCut& cut, PoseDerivatives& d);

struct RefinedPose {
  Pose view_from_template;
  double log_likelihood = 0;
  int evaluations = 0;
};

/// Levenberg-Marquardt on the pose, template fixed; never returns a worse pose than it was given.
RefinedPose refine_pose(ViewFrame& frame, const KernelLocalisations& view, const Pose& start,
                        float background, bool planar, int max_evaluations, const float* weight = nullptr,
                        const ViewCut* cut = nullptr);

/// exp(step) applied after view_from_template.
Pose perturbed(const Pose& view_from_template, const Vector6& step);

}  // namespace polar
