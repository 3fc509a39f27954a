// The autoencoder that ships (paper IV.A): PointNet without T-net as encoder, an MLP as decoder. With the
// batch norms folded in, E is 3 -> 64 ReLU -> 128 ReLU -> 1024 on every point, then the maximum over points;
// D is 1024 -> 1024 ReLU -> 1024 ReLU -> 3 x 1024.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "polar/model/autoencoder.hpp"

namespace polar {

using RowMatrixXf = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// y = weight x + bias.
struct Linear {
  RowMatrixXf weight;  // out x in
  Eigen::VectorXf bias;
};

struct PointNetWeights {
  std::array<Linear, 3> encoder;  // 64 x 3, 128 x 64, 1024 x 128
  std::array<Linear, 3> decoder;  // 1024 x 1024, 1024 x 1024, 3072 x 1024 (x, y, z of point 0, 1, ...)
};

/// Throws smlm::Error (input) naming `source`, if any, and the layer whose shape is wrong or whose values are
/// not finite.
void require_network(const PointNetWeights& weights, const std::string& source = {});

/// Throws like require_network.
std::unique_ptr<Autoencoder> make_pointnet(const PointNetWeights& weights);

/// dz_c / d(point critical[c]), 1024 x 3: exact, since the maximum passes its derivative to one point.
Eigen::Matrix<float, Eigen::Dynamic, 3> critical_jacobian(const PointNetWeights& weights,
                                                          const Eigen::Ref<const Eigen::Matrix3Xf>& cloud,
                                                          const Encoded& encoded);

}  // namespace polar
