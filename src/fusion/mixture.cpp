#include "polar/fusion/mixture.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "blocked_mixture.hpp"

namespace polar {

namespace {

constexpr int kMaxBlocks = 4096;  // the kernels' list of blocks in reach

// Halves [begin, end) along its widest axis at a multiple of 16 until one block is left.
void split(const Eigen::Matrix3Xf& centre, std::vector<int>& order, int begin, int end) {
  if (end - begin <= kernel::kBlock) return;
  Eigen::Vector3f low = centre.col(order[static_cast<std::size_t>(begin)]), high = low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(centre.col(order[static_cast<std::size_t>(i)]));
    high = high.cwiseMax(centre.col(order[static_cast<std::size_t>(i)]));
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const int blocks = (end - begin + kernel::kBlock - 1) / kernel::kBlock;
  const int middle = begin + blocks / 2 * kernel::kBlock;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int a, int b) {
    return centre(axis, a) != centre(axis, b) ? centre(axis, a) < centre(axis, b) : a < b;
  });
  split(centre, order, begin, middle);
  split(centre, order, middle, end);
}

void move(const Pose& pose, const std::vector<float>& x, const std::vector<float>& y,
          const std::vector<float>& z, std::vector<float>& u, std::vector<float>& v, std::vector<float>& w) {
  const Eigen::Matrix3f r = pose.rotation.cast<float>();
  const Eigen::Vector3f t = pose.translation.cast<float>();
  for (std::size_t i = 0; i < x.size(); ++i) {
    u[i] = r(0, 0) * x[i] + r(0, 1) * y[i] + r(0, 2) * z[i] + t[0];
    v[i] = r(1, 0) * x[i] + r(1, 1) * y[i] + r(1, 2) * z[i] + t[1];
    w[i] = r(2, 0) * x[i] + r(2, 1) * y[i] + r(2, 2) * z[i] + t[2];
  }
}

}  // namespace

void sort_into_blocks(Mixture& mixture) {
  std::vector<int> order(static_cast<std::size_t>(mixture.size()));
  std::iota(order.begin(), order.end(), 0);
  split(mixture.centre, order, 0, static_cast<int>(order.size()));
  const Mixture old = mixture;
  for (std::size_t i = 0; i < order.size(); ++i) {
    mixture.centre.col(static_cast<Eigen::Index>(i)) = old.centre.col(order[i]);
    mixture.weight[static_cast<Eigen::Index>(i)] = old.weight[order[i]];
  }
}

BlockedMixture::BlockedMixture(const Mixture& m)
    : blocks_(static_cast<int>((m.size() + kernel::kBlock - 1) / kernel::kBlock)),
      background_(static_cast<float>(m.outlier_fraction * m.outlier_density)) {
  if (blocks_ > kMaxBlocks) throw std::invalid_argument("a mixture holds at most 65,536 centres");
  const auto padded = static_cast<std::size_t>(padded_size());
  const auto padded_blocks =
      static_cast<std::size_t>((blocks_ + kernel::kBlock - 1) / kernel::kBlock * kernel::kBlock);
  for (auto* a : {&x_, &y_, &z_, &weight_}) a->assign(padded, 0.0f);
  for (auto* a : {&block_x_, &block_y_, &block_z_}) a->assign(padded_blocks, 0.0f);
  block_radius_.assign(padded_blocks, -1.0f);
  for (int b = 0; b < blocks_; ++b) {
    const Eigen::Index begin = Eigen::Index{b} * kernel::kBlock,
                       count = std::min<Eigen::Index>(kernel::kBlock, m.size() - begin);
    const auto part = m.centre.middleCols(begin, count);
    const Eigen::Vector3f middle = 0.5f * (part.rowwise().minCoeff() + part.rowwise().maxCoeff());
    const auto at = static_cast<std::size_t>(b);
    block_x_[at] = middle.x(), block_y_[at] = middle.y(), block_z_[at] = middle.z();
    block_radius_[at] = (part.colwise() - middle).colwise().norm().maxCoeff();
    for (Eigen::Index i = 0; i < kernel::kBlock; ++i) {
      const auto k = static_cast<std::size_t>(begin + i);
      const Eigen::Vector3f c = i < count ? Eigen::Vector3f(part.col(i)) : middle;
      x_[k] = c.x(), y_[k] = c.y(), z_[k] = c.z();
      weight_[k] = i < count ? m.weight[begin + i] * static_cast<float>(1.0 - m.outlier_fraction) : 0.0f;
    }
  }
}

ViewFrame::ViewFrame(const BlockedMixture& m)
    : mixture_(m),
      x_(m.x_),
      y_(m.y_),
      z_(m.z_),
      block_x_(m.block_x_),
      block_y_(m.block_y_),
      block_z_(m.block_z_),
      centres_{x_.data(),       y_.data(),       z_.data(),       m.weight_.data(),      m.blocks_,
               block_x_.data(), block_y_.data(), block_z_.data(), m.block_radius_.data()} {}

const kernel::Centres& ViewFrame::at(const Pose& view_from_template, const float* weight) {
  move(view_from_template, mixture_.x_, mixture_.y_, mixture_.z_, x_, y_, z_);
  move(view_from_template, mixture_.block_x_, mixture_.block_y_, mixture_.block_z_, block_x_, block_y_,
       block_z_);
  centres_.weight = weight ? weight : mixture_.weight_.data();
  return centres_;
}

}  // namespace polar
