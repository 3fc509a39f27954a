// R(z) (paper III.D, regularisation): the standard deviation over decoded points of the number of their
// neighbours. The paper's count jumps, so its gradient is zero; a smooth count really evens the density.
#pragma once

#include <Eigen/Core>

namespace polar {

/// b(x) = sum over other points y of (1 - |x - y|^2 / r^2)^2 within r; returns sigma_b (paper's n - 1
/// variance) and, unless null, its gradient in every point (3 x k).
double density_spread(const Eigen::Matrix3Xf& points, double radius, Eigen::Matrix3Xf* gradient);

}  // namespace polar
