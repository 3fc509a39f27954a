// The fused template as a mixture of Gaussians around centres, with a uniform class for outliers:
//   p(x) = (1 - e) sum_k w_k N(x; mu_k, C_x) + e u,   C_x = calibrated covariance of x + width^2 I.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

struct Mixture {
  Eigen::Matrix3Xf centre;  // 3 x K, template frame
  Eigen::VectorXf weight;   // K, sum 1
  double outlier_fraction = 0.05;
  double outlier_density = 0.1;  // length^-3; planar length^-2

  Eigen::Index size() const { return centre.cols(); }
};

/// Reorders the centres so that every 16 consecutive ones are neighbours; what the kernels' cut-off needs.
void sort_into_blocks(Mixture& mixture);

}  // namespace polar
