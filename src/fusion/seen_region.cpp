#include "polar/fusion/seen_region.hpp"

#include <algorithm>

#include "polar/core/spiral.hpp"

namespace polar {

namespace {
constexpr int kDirections = 96;
constexpr double kCounted = 0.985;  // share of the points along a direction
constexpr float kMargin = 0.01f;    // of the extent along the direction: the noise of an edge

std::vector<Eigen::Vector3f> spread_directions() {
  std::vector<Eigen::Vector3f> out;
  out.reserve(kDirections);
  for (int i = 0; i < kDirections; ++i)
    out.push_back(spiral_direction<float>(i, kDirections, Spiral::sphere));
  return out;
}

const std::vector<Eigen::Vector3f>& directions() {
  static const std::vector<Eigen::Vector3f> all = spread_directions();
  return all;
}
}  // namespace

SeenRegion::SeenRegion(const Eigen::Matrix3Xf& points) {
  if (points.cols() == 0) return;
  std::vector<float> along(static_cast<std::size_t>(points.cols()));
  const auto quantile = [&](double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(along.size() - 1));
    std::nth_element(along.begin(), along.begin() + at, along.end());
    return along[static_cast<std::size_t>(at)];
  };
  for (const Eigen::Vector3f& d : directions()) {
    Eigen::Map<Eigen::RowVectorXf>(along.data(), points.cols()) = d.transpose() * points;
    const float near = quantile(1 - kCounted), far = quantile(kCounted);
    farthest_.push_back(far - kMargin * (far - near));
  }
}

bool SeenRegion::contains(const Eigen::Vector3f& x) const {
  if (farthest_.empty()) return false;
  for (int d = 0; d < kDirections; ++d)
    if (directions()[static_cast<std::size_t>(d)].dot(x) > farthest_[static_cast<std::size_t>(d)])
      return false;
  return true;
}

}  // namespace polar
