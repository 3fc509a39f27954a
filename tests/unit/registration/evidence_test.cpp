#include "registration/data/evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace polar {
namespace {

TEST(Evidence, isComparedViewByView) {
  const Comparison c = compare({1, 2, 3, 4}, {2, 4, 4, 6});  // differences 1 2 1 2
  EXPECT_DOUBLE_EQ(c.gain, 1.5);
  EXPECT_NEAR(c.standard_error, 0.5 / std::sqrt(3.0), 1e-12);  // standard deviation over sqrt(n - 1)
  EXPECT_TRUE(c.better_by(5));
  EXPECT_FALSE(c.better_by(5.2));
}

TEST(Evidence, aViewThatSaysNothingCountsOnNeitherSide) {
  const Comparison c = compare({1, NAN, 3}, {2, 100, NAN});
  EXPECT_EQ(c.views, 1);
  EXPECT_DOUBLE_EQ(c.gain, 1);
  EXPECT_DOUBLE_EQ(mean_evidence({1, NAN, 3}), 2);
}

TEST(Evidence, notWorseIsNotBetter) {
  const Comparison c = compare({1, 1, 1, 1}, {0.9, 1.1, 0.9, 1.0});
  EXPECT_LT(c.gain, 0);
  EXPECT_FALSE(c.better_by(0));
  EXPECT_TRUE(c.better_by(-2));
  EXPECT_FALSE(compare({}, {}).better_by(-10));
}

}  // namespace
}  // namespace polar
