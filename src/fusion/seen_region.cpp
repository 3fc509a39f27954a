#include "polar/fusion/seen_region.hpp"

#include "extent.hpp"
#include "polar/core/spiral.hpp"

namespace polar {

namespace {
constexpr int kDirections = 96;
constexpr double kCounted = 0.985;  // share of the points along a direction
constexpr float kMargin = 0.01f;    // of the extent along the direction: the noise of an edge

const std::vector<Eigen::Vector3f>& directions() {
  static const std::vector<Eigen::Vector3f> all = spiral_directions<float>(kDirections, Spiral::sphere);
  return all;
}
}  // namespace

SeenRegion::SeenRegion(const Eigen::Matrix3Xf& points) {
  if (points.cols() == 0) return;
  Extent extent(points);
  for (const Eigen::Vector3f& d : directions()) {
    extent.project(d);
    const float near = extent.quantile(1 - kCounted), far = extent.quantile(kCounted);
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
