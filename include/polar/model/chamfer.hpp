// The two-sided Chamfer distance (paper eq. for d_CD): mean distance to the nearest point, there and back.
#pragma once

#include <Eigen/Core>

namespace polar {

struct Chamfer {
  double a_to_b = 0, b_to_a = 0;  // mean distances
  double sum() const { return a_to_b + b_to_a; }
};

/// Both clouds need at least one point.
Chamfer chamfer(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b);

/// The same, and the gradient of its sum in a, 3 x n (0 where two points coincide, the distance's kink).
Chamfer chamfer_gradient(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b, Eigen::Matrix3Xf& gradient);

}  // namespace polar
