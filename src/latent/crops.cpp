#include "crops.hpp"

#include <cmath>

#include "mask.hpp"
#include "polar/core/constants.hpp"

namespace polar {

namespace {

// Fibonacci's lattice: evenly spread, the same every time.
Eigen::Vector3f direction(int k, int of, bool planar) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  const double height = planar ? 0 : 1 - (2 * k + 1.0) / of, angle = planar ? 2 * kPi * k / of : golden * k;
  const double radius = std::sqrt(1 - height * height);
  return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), height).cast<float>();
}

}  // namespace

std::vector<Crop> plane_crops(const Eigen::Matrix3Xf& points, double share, int directions, int most,
                              bool planar) {
  std::vector<Crop> crops(static_cast<std::size_t>(directions));
  for (int k = 0; k < directions; ++k) {
    Crop& crop = crops[static_cast<std::size_t>(k)];
    crop.kept = nearest_share(points.transpose() * direction(k, directions, planar), share);
    crop.centre = columns(points, crop.kept).rowwise().mean();
    crop.kept.resize(std::min(crop.kept.size(), static_cast<std::size_t>(most)));
    crop.points = columns(points, crop.kept).colwise() - crop.centre;
  }
  return crops;
}

}  // namespace polar
