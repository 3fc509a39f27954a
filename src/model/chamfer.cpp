#include "polar/model/chamfer.hpp"

#include <vector>

#include "polar/model/nearest.hpp"

namespace polar {

namespace {
constexpr float kCoincident = 1e-12f;  // below it the direction of a difference is rounding

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
  const auto ignore = [](Eigen::Index, Eigen::Index, const Eigen::Vector3f&) {};
  return {mean_distance(a, b, nearest(a, b), ignore), mean_distance(b, a, nearest(b, a), ignore)};
}

Chamfer chamfer_gradient(const Eigen::Matrix3Xf& a, const Eigen::Matrix3Xf& b, Eigen::Matrix3Xf& gradient) {
  gradient = Eigen::Matrix3Xf::Zero(3, a.cols());
  const float per_a = 1.0f / static_cast<float>(a.cols()), per_b = 1.0f / static_cast<float>(b.cols());
  Chamfer result;
  result.a_to_b = mean_distance(
      a, b, nearest(a, b),
      [&](Eigen::Index i, Eigen::Index, const Eigen::Vector3f& u) { gradient.col(i) += per_a * u; });
  result.b_to_a = mean_distance(
      b, a, nearest(b, a),
      [&](Eigen::Index, Eigen::Index j, const Eigen::Vector3f& u) { gradient.col(j) -= per_b * u; });
  return result;
}

}  // namespace polar
