#include "polar/model/chamfer.hpp"

#include <vector>

#include "model/kernel_table.hpp"

namespace polar {

namespace {
constexpr Eigen::Index kPad = 16;      // Table::nearest reads whole vectors
constexpr float kNeverNear = 1e30f;    // half square of the padding
constexpr float kCoincident = 1e-12f;  // below it the direction of a difference is rounding

/// Coordinates apart, padded to whole vectors.
struct Split {
  explicit Split(const Eigen::Matrix3Xf& cloud)
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

std::vector<int> nearest(const Split& from, Eigen::Index count, const Split& to) {
  std::vector<int> index(static_cast<std::size_t>(count));
  kernel::active_table().nearest(static_cast<int>(count), from.axis(0), from.axis(1), from.axis(2),
                                 static_cast<int>(to.n), to.axis(0), to.axis(1), to.axis(2), to.axis(3),
                                 index.data());
  return index;
}

/// Mean |a_i - b_nearest(i)|; `visit(i, j, (a_i - b_j) / |a_i - b_j|)` for every pair apart.
template <typename Visit>
double mean_distance(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b, const std::vector<int>& index,
                     Visit visit) {
  double sum = 0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    const Eigen::Index j = index[static_cast<std::size_t>(i)];
    const Eigen::Vector3f d = a.col(i) - b.col(j);
    const float norm = d.norm();
    sum += static_cast<double>(norm);
    if (norm > kCoincident) visit(i, j, Eigen::Vector3f(d / norm));
  }
  return sum / static_cast<double>(a.cols());
}
}  // namespace

Chamfer chamfer(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b) {
  const Split sa(a), sb(b);
  const auto ignore = [](Eigen::Index, Eigen::Index, const Eigen::Vector3f&) {};
  return {mean_distance(a, b, nearest(sa, a.cols(), sb), ignore),
          mean_distance(b, a, nearest(sb, b.cols(), sa), ignore)};
}

Chamfer chamfer_gradient(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b, Eigen::Matrix3Xf& gradient) {
  const Split sa(a), sb(b);
  gradient = Eigen::Matrix3Xf::Zero(3, a.cols());
  const float per_a = 1.0f / static_cast<float>(a.cols()), per_b = 1.0f / static_cast<float>(b.cols());
  Chamfer result;
  result.a_to_b = mean_distance(
      a, b, nearest(sa, a.cols(), sb),
      [&](Eigen::Index i, Eigen::Index, const Eigen::Vector3f& u) { gradient.col(i) += per_a * u; });
  result.b_to_a = mean_distance(
      b, a, nearest(sb, b.cols(), sa),
      [&](Eigen::Index, Eigen::Index j, const Eigen::Vector3f& u) { gradient.col(j) -= per_b * u; });
  return result;
}

}  // namespace polar
