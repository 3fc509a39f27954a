#include "polar/latent/density.hpp"

#include <cmath>

namespace polar {

namespace {
constexpr double kEven = 1e-9;  // below it the spread has its kink at 0
}

double density_spread(const Eigen::Matrix3Xf& points, double radius, Eigen::Matrix3Xf* gradient) {
  const Eigen::Index k = points.cols();
  if (gradient) *gradient = Eigen::Matrix3Xf::Zero(3, k);
  if (k < 2) return 0;
  const auto reach = static_cast<float>(1 / (radius * radius));
  const Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::RowMajor> p = points;
  Eigen::VectorXd count = Eigen::VectorXd::Zero(k);
  const auto closeness = [&](Eigen::Index i, Eigen::Index j) {  // 1 at distance 0, 0 from the radius on
    const float x = p(0, i) - p(0, j), y = p(1, i) - p(1, j), z = p(2, i) - p(2, j);
    return std::max(0.0f, 1.0f - reach * (x * x + y * y + z * z));
  };
  for (Eigen::Index i = 0; i < k; ++i) {
    float near = 0;
    for (Eigen::Index j = 0; j < k; ++j) {
      const float c = closeness(i, j);
      near += c * c;
    }
    count[i] = static_cast<double>(near) - 1;  // without the point itself
  }
  const double mean = count.mean();
  const double spread = std::sqrt((count.array() - mean).square().sum() / static_cast<double>(k - 1));
  if (!gradient || spread < kEven) return spread;
  // d sigma = sum_i (b_i - mean) db_i / ((k - 1) sigma); the mean's own change drops out.
  const Eigen::VectorXf pull = ((count.array() - mean) / (static_cast<double>(k - 1) * spread)).cast<float>();
  for (Eigen::Index i = 0; i < k; ++i) {
    Eigen::Vector3f g = Eigen::Vector3f::Zero();
    for (Eigen::Index j = 0; j < k; ++j) {
      const float c = closeness(i, j);
      if (c > 0) g += (pull[i] + pull[j]) * (-4 * reach * c) * (points.col(i) - points.col(j));
    }
    gradient->col(i) = g;
  }
  return spread;
}

}  // namespace polar
