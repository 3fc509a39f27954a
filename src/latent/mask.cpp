#include "mask.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/model/nearest.hpp"

namespace polar {

Eigen::VectorXf nearest_distances(const Eigen::Matrix3Xf& from, const Eigen::Matrix3Xf& to) {
  const std::vector<int> index = nearest(from, to);
  Eigen::VectorXf distance(from.cols());
  for (Eigen::Index i = 0; i < from.cols(); ++i)
    distance[i] = (from.col(i) - to.col(index[static_cast<std::size_t>(i)])).norm();
  return distance;
}

std::vector<int> nearest_share(const Eigen::VectorXf& distance, double share) {
  std::vector<int> order(static_cast<std::size_t>(distance.size()));
  std::iota(order.begin(), order.end(), 0);
  const double wanted = std::round(share * static_cast<double>(distance.size()));
  const std::size_t kept = std::min(order.size(), static_cast<std::size_t>(std::max(1.0, wanted)));
  if (kept == order.size()) return order;
  std::nth_element(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(),
      [&](int a, int b) { return distance[a] < distance[b] || (distance[a] == distance[b] && a < b); });
  order.resize(kept);
  std::sort(order.begin(), order.end());
  return order;
}

Eigen::Matrix3Xf columns(const Eigen::Matrix3Xf& cloud, const std::vector<int>& which) {
  Eigen::Matrix3Xf out(3, static_cast<Eigen::Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k) out.col(static_cast<Eigen::Index>(k)) = cloud.col(which[k]);
  return out;
}

}  // namespace polar
