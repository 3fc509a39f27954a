// The encoder with batch norms over all points of a batch of clouds, forward and backward, without ever
// holding more than a tile of the 1024-channel layer.
//
// Both norms come before the maximum, but their statistics do not need a second pass through the layers: the
// input of norm 1 is linear in x, that of norm 2 linear in h1, so their moments follow from the moments of x
// (3 x 3) and of h1 (64 x 64). Backward, the maximum passes derivatives to the critical points alone (a few
// hundred a cloud); what the norms spread over all other points is an affine function of h1, so its sums
// need one 64 x 64 product a point.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/encoder_panels.hpp"
#include "model/parameters.hpp"

namespace polar {

constexpr std::size_t kCloudsPerBlock = 4;  // partial sums are added in the order of such blocks

class EncoderStep {
 public:
  /// Latent vectors, clouds x 1024.
  RowMatrixXf forward(const std::vector<float>& parameters, const std::vector<Eigen::Matrix3Xf>& clouds);

  /// Writes the encoder's part of `gradient` for dL/dlatent (clouds x 1024); after forward() with the same
  /// parameters and clouds.
  void backward(const std::vector<float>& parameters, const std::vector<Eigen::Matrix3Xf>& clouds,
                const RowMatrixXf& latent_gradient, std::vector<float>& gradient) const;

  const Moments& moments(std::size_t norm) const { return moments_[norm]; }

 private:
  struct Sparse;
  Sparse critical_pass(const std::vector<float>& parameters, const std::vector<Eigen::Matrix3Xf>& clouds,
                       const RowMatrixXf& latent_gradient) const;

  double points_ = 0;  // of all clouds
  Eigen::Vector3d x_mean_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d x_second_ = Eigen::Matrix3d::Zero();  // E[x x^T]
  Eigen::VectorXd h_mean_;                              // E[h1]
  Eigen::MatrixXd h_second_;                            // E[h1 h1^T]
  Moments moments_[2];
  PackedEncoder packed_;
  std::vector<Encoded> encoded_;
};

}  // namespace polar
