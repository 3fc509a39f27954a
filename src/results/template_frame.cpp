#include "polar/results/template_frame.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "polar/core/so3.hpp"

namespace polar {

namespace {
// Third moment along an axis: its sign says which side reaches farther out.
double skewness(const Eigen::Matrix3Xd& about_centre, const Eigen::VectorXd& weight,
                const Eigen::Vector3d& axis) {
  return (about_centre.transpose() * axis).array().cube().matrix().dot(weight);
}

Eigen::Vector3d towards_the_far_side(const Eigen::Matrix3Xd& x, const Eigen::VectorXd& weight,
                                     const Eigen::Vector3d& axis) {
  const double moment = skewness(x, weight, axis);
  if (moment != 0) return moment < 0 ? Eigen::Vector3d(-axis) : axis;
  Eigen::Index largest = 0;  // neither does: an eigenvector's sign is then a convention
  axis.cwiseAbs().maxCoeff(&largest);
  return axis[largest] < 0 ? Eigen::Vector3d(-axis) : axis;
}

Eigen::Matrix3d rows(const Eigen::Vector3d& x, const Eigen::Vector3d& z) {
  Eigen::Matrix3d r;
  r << x.transpose(), z.cross(x).transpose(), z.transpose();
  return r;
}

Pose principal_frame(const FusedTemplate& fused, bool planar) {
  const Eigen::VectorXd weight = fused.weight / fused.weight.sum();
  const Eigen::Vector3d centre = fused.centre * weight;
  const Eigen::Matrix3Xd about = fused.centre.colwise() - centre;
  const Eigen::Matrix3d spread = about * weight.asDiagonal() * about.transpose();
  Eigen::Vector3d x, z = Eigen::Vector3d::UnitZ();
  if (planar) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread.topLeftCorner<2, 2>());
    x << axes.eigenvectors().col(1), 0;
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);  // widths ascending
    const Eigen::Vector3d width = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
    const bool rod = width[2] - width[1] > width[1] - width[0];
    z = towards_the_far_side(about, weight, axes.eigenvectors().col(rod ? 2 : 0));
    x = axes.eigenvectors().col(rod ? 1 : 2);
  }
  x = towards_the_far_side(about, weight, x);
  const Eigen::Matrix3d rotation = nearest_rotation(rows(x, z));
  return {rotation, -(rotation * centre)};
}
}  // namespace

Pose own_frame_from_template(const Registration& r, bool planar) {
  const bool symmetric = r.symmetry && r.symmetry->group != "C1";
  if (symmetric) return r.symmetry->canonical_from_template;
  if (r.fused.centre.cols() == 0 || !(r.fused.weight.sum() > 0)) return {};
  return principal_frame(r.fused, planar);
}

void move_template(Registration& r, const Pose& new_from_old) {
  const Eigen::Matrix3d& rotation = new_from_old.rotation;
  // x -> exp(w) x + v about the old origin is, about the new one, turned and moved by the lever t.
  Eigen::Matrix<double, 6, 6> lever = Eigen::Matrix<double, 6, 6>::Zero();
  lever.topLeftCorner<3, 3>() = lever.bottomRightCorner<3, 3>() = rotation;
  lever.bottomLeftCorner<3, 3>() = cross_matrix(new_from_old.translation) * rotation;
  for (RegisteredView& view : r.view) {
    view.template_from_view = new_from_old * view.template_from_view;
    view.covariance = lever * view.covariance * lever.transpose();
  }
  r.fused.centre = (rotation * r.fused.centre).colwise() + new_from_old.translation;
  if (r.other)
    r.other->fused.centre = (rotation * r.other->fused.centre).colwise() + new_from_old.translation;
  if (!r.symmetry) return;
  r.symmetry->canonical_from_template = r.symmetry->canonical_from_template * new_from_old.inverse();
  r.symmetry->unit = (rotation * r.symmetry->unit).colwise() + new_from_old.translation;
}

}  // namespace polar
