// Owns encoder weights in the layout of the kernels and runs a whole cloud through them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/kernel_table.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/model/pointnet.hpp"

namespace polar {

class PackedEncoder {
 public:
  PackedEncoder() = default;
  explicit PackedEncoder(const std::array<Linear, 3>& layers);

  kernel::EncoderPanels panels() const;
  /// Latent and critical points; no check of the values.
  Encoded encode(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud) const;

 private:
  std::vector<float> w1_, b1_, w2_, b2_, w3_, b3_;
};

/// First layer's output of n points into rows of kHidden1 floats, block by block: body(first point, points in
/// the block, h). h has kernel::kBlock rows, zero past the points, and kHidden1 readable floats after them.
template <typename Body>
void hidden1_blocks(const kernel::EncoderPanels& panels, const float* xyz, Eigen::Index n, Body body) {
  std::vector<float> h(kernel::kScratch, 0.0f);
  for (Eigen::Index first = 0; first < n; first += kernel::kBlock) {
    const int count = static_cast<int>(std::min<Eigen::Index>(kernel::kBlock, n - first));
    kernel::active_table().hidden1(panels, xyz + 3 * first, count, h.data());
    body(first, count, h.data());
  }
}

}  // namespace polar
