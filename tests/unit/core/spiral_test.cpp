#include "polar/core/spiral.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace polar {
namespace {

TEST(SpiralDirection, coversTheSphereEvenly) {
  constexpr int kCount = 200;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double widest = 1;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d d = spiral_direction<double>(i, kCount, Spiral::sphere);
    EXPECT_NEAR(d.norm(), 1, 1e-12);
    sum += d;
    double nearest = -1;
    for (int j = 0; j < kCount; ++j)
      if (j != i) nearest = std::max(nearest, d.dot(spiral_direction<double>(j, kCount, Spiral::sphere)));
    widest = std::min(widest, nearest);
  }
  EXPECT_LT(sum.norm() / kCount, 0.01);  // of as many at random: 0.07
  // 200 caps of equal area have a radius of 8.1 degrees, and neighbours are about twice as far apart.
  EXPECT_GT(widest, std::cos(20 * kRadiansPerDegree));
}

TEST(SpiralDirection, staysOnItsHemisphere) {
  double lowest = 1;
  for (int i = 0; i < 64; ++i)
    lowest = std::min(lowest, double(spiral_direction<float>(i, 64, Spiral::hemisphere).z()));
  EXPECT_GT(lowest, 0);
  EXPECT_LT(lowest, 0.02);  // down to the equator
}

}  // namespace
}  // namespace polar
