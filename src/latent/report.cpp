#include "report.hpp"

#include "polar/core/parallel.hpp"

namespace polar {

namespace {

Pose in_views_units(const Pose& view_from_template, double scale) {
  Pose pose = view_from_template.inverse();
  pose.translation /= scale;
  return pose;
}

Eigen::Matrix<double, 6, 6> covariance(const LossTerm& term, const Pose& view_from_template, bool planar,
                                       double scale) {
  Eigen::Matrix<double, 6, 6> normal = (term.jacobian.transpose() * term.jacobian).cast<double>();
  if (planar)
    for (const int k : {0, 1, 5}) normal.row(k).setZero(), normal.col(k).setZero();
  const double freedom = static_cast<double>(term.residual.size()) - (planar ? 3 : 6);
  const Eigen::Matrix<double, 6, 6> inverse = normal.completeOrthogonalDecomposition().pseudoInverse();
  // R <- exp(w) R, t <- t + v leaves R^T (y - t), the inverse, multiplied from the left by exp(-R^T w) and
  // shifted by -R^T v.
  const Eigen::Matrix3d back = -view_from_template.rotation.transpose();
  Eigen::Matrix<double, 6, 6> change = Eigen::Matrix<double, 6, 6>::Zero();
  change.topLeftCorner<3, 3>() = back;
  change.bottomRightCorner<3, 3>() = back / scale;
  return term.loss / freedom * change * inverse * change.transpose();
}

}  // namespace

void report(const Autoencoder& model, const LatentViews& views, const Eigen::Matrix3Xf& points,
            const PosedViews& state, const std::vector<DescendedPose>& second, LatentRegistration& out) {
  out.template_points = points.cast<double>() / views.scale;
  parallel_for(views.view.size(), [&](std::size_t i) {
    const LatentView& view = views.view[i];
    LatentPose& pose = out.view[i];
    pose.n_used = static_cast<int>(view.points.cols());
    if (view.empty()) return;
    const Pose& at = state.view_from_template[i];
    pose.template_from_view = in_views_units(at, views.scale);
    pose.loss = state.loss[i];
    pose.second = in_views_units(second[i].view_from_template, views.scale);
    pose.second_loss = second[i].loss;
    pose.visibility = view.visibility;
    pose.outlier_fraction = view.outlier_fraction;
    pose.covariance =
        covariance(view_loss(model, view, points, at, Derive::pose), at, views.planar, views.scale);
  });
}

}  // namespace polar
