#include "evenness.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace polar {

namespace {
constexpr double kThinQuantile = 0.25;
constexpr double kCountingNoise = 0.5;  // standard deviations of a count
constexpr Eigen::Index kMostCounted =
    2000;  // localisations that stand for a particle: densities are relative
}  // namespace

std::vector<double> even_weights(const Eigen::Matrix3Xf& points, double reach) {
  const Eigen::Index n = points.cols();
  std::vector<double> weight(static_cast<std::size_t>(n), 1.0);
  if (n == 0) return weight;
  const Eigen::Index stride = (n + kMostCounted - 1) / kMostCounted;
  Eigen::Matrix3Xf sample(3, (n + stride - 1) / stride);
  for (Eigen::Index k = 0; k < sample.cols(); ++k) sample.col(k) = points.col(k * stride);
  const auto r2 = static_cast<float>(reach * reach);
  for (Eigen::Index j = 0; j < n; ++j)
    weight[static_cast<std::size_t>(j)] = static_cast<double>(std::max<Eigen::Index>(
        1, ((sample.colwise() - points.col(j)).colwise().squaredNorm().array() <= r2).count()));
  std::vector<double> sorted = weight;
  const auto quarter = sorted.begin() + static_cast<std::ptrdiff_t>(kThinQuantile * static_cast<double>(n));
  std::nth_element(sorted.begin(), quarter, sorted.end());
  const double allowed = *quarter + kCountingNoise * std::sqrt(*quarter);
  for (double& w : weight) w = std::min(1.0, allowed / w);
  return weight;
}

std::vector<std::uint32_t> sampling_order(const std::vector<double>& weight, KeyedRandom random) {
  // P. S. Efraimidis, P. G. Spirakis, Weighted random sampling with a reservoir, Information Processing
  // Letters 97, 2006.
  std::vector<double> key(weight.size());
  for (std::size_t j = 0; j < key.size(); ++j) key[j] = -std::log(1.0 - random.uniform()) / weight[j];
  std::vector<std::uint32_t> order(weight.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key[a] != key[b] ? key[a] < key[b] : a < b; });
  return order;
}

}  // namespace polar
