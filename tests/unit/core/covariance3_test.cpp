#include "polar/core/covariance3.hpp"

#include <gtest/gtest.h>

namespace polar {
namespace {

TEST(Covariance3, SixNumbersAreTheUpperHalfRowByRow) {
  Eigen::Matrix3d expected;
  expected << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  EXPECT_EQ(matrix({1, 2, 3, 4, 5, 6}), expected);
  EXPECT_EQ(symmetric3(expected), (Symmetric3{1, 2, 3, 4, 5, 6}));
}

TEST(Covariance3, VariancesStandOnTheDiagonal) {
  EXPECT_EQ(matrix(isotropic_covariance(2)), 2 * Eigen::Matrix3d::Identity());
  EXPECT_EQ(matrix(axial_covariance(2, 3)), Eigen::Vector3d(2, 2, 3).asDiagonal().toDenseMatrix());
}

}  // namespace
}  // namespace polar
