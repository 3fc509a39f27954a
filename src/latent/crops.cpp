#include "crops.hpp"

#include <cmath>

#include "mask.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/spiral.hpp"

namespace polar {

namespace {

Eigen::Vector3f direction(int k, int of, bool planar) {
  if (!planar) return spiral_direction<double>(k, of, Spiral::sphere).cast<float>();
  const double angle = 2 * kPi * k / of;
  return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>();
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
