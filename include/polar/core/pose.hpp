// Rigid motions. A pose is named `b_from_a` and maps points: x_in_b = b_from_a * x_in_a, so a
// composition reads off its names: `c_from_b * b_from_a` is `c_from_a`.
#pragma once

#include <Eigen/Geometry>

namespace polar {

struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return rotation * x + translation; }
  Pose operator*(const Pose& other) const {
    return {rotation * other.rotation, rotation * other.translation + translation};
  }
  Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

}  // namespace polar
