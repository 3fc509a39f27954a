#include "polar/core/so3.hpp"

#include <gtest/gtest.h>

#include "polar/core/constants.hpp"
#include "polar/core/pose.hpp"
#include "polar/core/rng.hpp"

namespace polar {
namespace {

TEST(So3, logarithmInvertsExponentialFromTinyToHalfTurns) {
  KeyedRandom random(1, 0, 0);
  for (const double angle : {1e-9, 1e-5, 1e-3, 0.5, 2.0, kPi - 1e-4}) {
    const Eigen::Vector3d w = angle * random.direction();
    EXPECT_LT((so3_log(so3_exp(w)) - w).norm(), 1e-9 * (1 + angle)) << angle;
  }
}

TEST(So3, exponentialIsARotationAboutItsAxis) {
  const Eigen::Vector3d w(0.3, -1.2, 0.7);
  const Eigen::Matrix3d r = so3_exp(w);
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(r.determinant(), 1, 1e-12);
  EXPECT_LT((r * w - w).norm(), 1e-12);
  EXPECT_LT((r - Eigen::AngleAxisd(w.norm(), w.normalized()).toRotationMatrix()).norm(), 1e-12);
}

TEST(So3, geodesicAngleIsExactNearZeroWhereTheTraceIsNot) {
  const Eigen::Matrix3d a = so3_exp({1, 2, 3});
  EXPECT_NEAR(geodesic_angle(a, a * so3_exp({0, 1e-8, 0})), 1e-8, 1e-14);
  EXPECT_NEAR(geodesic_angle(a, a * so3_exp({0, 0, kPi})), kPi, 1e-7);
}

TEST(So3, nearestRotationRepairsAndNeverMirrors) {
  const Eigen::Matrix3d r = so3_exp({0.4, 0.1, -0.9});
  EXPECT_LT((nearest_rotation(1.7 * r) - r).norm(), 1e-12);
  EXPECT_NEAR(nearest_rotation(-r).determinant(), 1, 1e-12);
}

TEST(Pose, compositionReadsOffItsNames) {
  const Pose b_from_a{so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}}, c_from_b{so3_exp({-0.5, 0, 0.2}), {0, -1, 4}};
  const Eigen::Vector3d x_a(0.3, -0.7, 2);
  EXPECT_LT(((c_from_b * b_from_a) * x_a - c_from_b * (b_from_a * x_a)).norm(), 1e-12);
  EXPECT_LT((b_from_a.inverse() * (b_from_a * x_a) - x_a).norm(), 1e-12);
}

}  // namespace
}  // namespace polar
