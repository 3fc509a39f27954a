#include "polar/model/nearest.hpp"

#include "model/kernel_table.hpp"

namespace polar {

namespace {
constexpr Eigen::Index kPad = 16;    // Table::nearest reads whole vectors
constexpr float kNeverNear = 1e30f;  // half square of the padding

/// Coordinates apart, padded to whole vectors.
struct Split {
  explicit Split(const Eigen::Ref<const Eigen::Matrix3Xf>& cloud)
      : n((cloud.cols() + kPad - 1) / kPad * kPad), values(static_cast<std::size_t>(4 * n), 0.0f) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const bool real = i < cloud.cols();
      for (Eigen::Index a = 0; a < 3 && real; ++a) values[static_cast<std::size_t>(a * n + i)] = cloud(a, i);
      values[static_cast<std::size_t>(3 * n + i)] = real ? 0.5f * cloud.col(i).squaredNorm() : kNeverNear;
    }
  }
  const float* axis(Eigen::Index a) const { return values.data() + a * n; }
  Eigen::Index n;
  std::vector<float> values;
};
}  // namespace

std::vector<int> nearest(const Eigen::Ref<const Eigen::Matrix3Xf>& from,
                         const Eigen::Ref<const Eigen::Matrix3Xf>& to) {
  const Split a(from), b(to);
  std::vector<int> index(static_cast<std::size_t>(from.cols()));
  kernel::active_table().nearest(static_cast<int>(from.cols()), a.axis(0), a.axis(1), a.axis(2),
                                 static_cast<int>(b.n), b.axis(0), b.axis(1), b.axis(2), b.axis(3),
                                 index.data());
  return index;
}

}  // namespace polar
