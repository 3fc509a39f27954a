#include "polar/fusion/discretise.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace polar {

Mixture merged(const Mixture& mixture, double distance) {
  const auto n = static_cast<std::size_t>(mixture.size());
  std::vector<Eigen::Index> order(n);
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  // Local weight (a soft count of neighbours) leads: the densest spot becomes a centre first.
  const auto d2 = static_cast<float>(distance * distance);
  std::vector<float> density(n, 0.0f);
  for (std::size_t i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < mixture.size(); ++j)
      if ((mixture.centre.col(static_cast<Eigen::Index>(i)) - mixture.centre.col(j)).squaredNorm() < d2)
        density[i] += mixture.weight[j];
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return density[static_cast<std::size_t>(a)] > density[static_cast<std::size_t>(b)];
  });
  std::vector<Eigen::Vector3f> seed;
  for (const Eigen::Index i : order) {
    const Eigen::Vector3f c = mixture.centre.col(i);
    const bool near =
        std::any_of(seed.begin(), seed.end(), [&](const auto& s) { return (s - c).squaredNorm() < d2; });
    if (!near) seed.push_back(c);
  }
  Mixture out = mixture;
  out.centre = Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(seed.size()));
  out.weight = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(seed.size()));
  for (Eigen::Index j = 0; j < mixture.size(); ++j) {
    const auto nearest = std::min_element(seed.begin(), seed.end(), [&](const auto& a, const auto& b) {
      return (a - mixture.centre.col(j)).squaredNorm() < (b - mixture.centre.col(j)).squaredNorm();
    });
    const auto k = static_cast<Eigen::Index>(nearest - seed.begin());
    out.centre.col(k) += mixture.weight[j] * mixture.centre.col(j);
    out.weight[k] += mixture.weight[j];
  }
  for (Eigen::Index k = 0; k < out.size(); ++k)
    out.centre.col(k) = out.weight[k] > 0 ? Eigen::Vector3f(out.centre.col(k) / out.weight[k])
                                          : seed[static_cast<std::size_t>(k)];
  sort_into_blocks(out);
  return out;
}

}  // namespace polar
