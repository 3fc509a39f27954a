#include "model/encoder_panels.hpp"

#include <algorithm>
#include <limits>

#include "model/gemm.hpp"

namespace polar {

using kernel::kBlock;
using kernel::kHidden1;
using kernel::kHidden2;
using kernel::kLatent;

PackedEncoder::PackedEncoder(const std::array<Linear, 3>& layers) : w1_(3 * kHidden1) {
  for (int c = 0; c < kHidden1; ++c)
    for (int a = 0; a < 3; ++a) w1_[static_cast<std::size_t>(a * kHidden1 + c)] = layers[0].weight(c, a);
  const auto bias = [](const Linear& l) {
    return std::vector<float>(l.bias.data(), l.bias.data() + l.bias.size());
  };
  b1_ = bias(layers[0]);
  b2_ = bias(layers[1]);
  b3_ = bias(layers[2]);
  w2_ = pack_panels(kHidden1, kHidden2, transposed(row_major(layers[1].weight.data(), kHidden1)));
  w3_ = pack_panels(kHidden2, kLatent, transposed(row_major(layers[2].weight.data(), kHidden2)));
}

kernel::EncoderPanels PackedEncoder::panels() const {
  return {w1_.data(), b1_.data(), w2_.data(), b2_.data(), w3_.data()};
}

Encoded PackedEncoder::encode(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud) const {
  thread_local std::vector<float> scratch(kernel::kScratch);
  const kernel::Table& table = kernel::active_table();
  const kernel::EncoderPanels w = panels();
  Encoded out{Eigen::VectorXf::Constant(kLatent, -std::numeric_limits<float>::max()),
              Eigen::VectorXi::Constant(kLatent, -1)};
  for (Eigen::Index first = 0; first < cloud.cols(); first += kBlock) {
    const int n = static_cast<int>(std::min<Eigen::Index>(kBlock, cloud.cols() - first));
    table.encode_block(w, cloud.data() + 3 * first, n, static_cast<int>(first), out.latent.data(),
                       out.critical.data(), scratch.data());
  }
  out.latent += Eigen::Map<const Eigen::VectorXf>(b3_.data(), kLatent);
  return out;
}

}  // namespace polar
