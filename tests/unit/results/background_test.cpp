#include "results/background.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"

namespace polar::results {
namespace {

// Evenly in a box of these half lengths, or in the ellipsoid within it; after them rows of something else.
smlm::LocalisationTable filled(const std::array<double, 3>& half_nm, bool round, bool planar) {
  smlm::LocalisationTable t;
  t.planar = planar;
  KeyedRandom random(3, 0, 1);
  while (t.size() < 4000) {
    std::array<double, 3> u{};
    double square = 0;
    for (std::size_t axis = 0; axis < (planar ? 2u : 3u); ++axis) {
      u[axis] = 2 * random.uniform() - 1;
      square += u[axis] * u[axis];
    }
    if (round && square > 1) continue;
    t.position_nm.push_back({7 + half_nm[0] * u[0], half_nm[1] * u[1], planar ? 0 : half_nm[2] * u[2]});
  }
  for (int i = 0; i < 500; ++i) t.position_nm.push_back({0, 0, 0});
  return t;
}

double belongs(std::size_t row) { return row < 4000 ? 1 : 0; }

TEST(Background, FillsBallsEllipsoidsAndPicks) {
  EXPECT_NEAR(background_density(filled({90, 90, 90}, true, false), belongs, 1) * 4 * kPi / 3 * 90 * 90 * 90,
              1, 0.05);
  EXPECT_NEAR(background_density(filled({90, 40, 20}, true, false), belongs, 1) * 4 * kPi / 3 * 90 * 40 * 20,
              1, 0.05);
  EXPECT_NEAR(background_density(filled({50, 50, 0}, true, true), belongs, 1) * kPi * 50 * 50, 1, 0.05);
}

TEST(Background, OfABoxIsRightToAnEighth) {
  EXPECT_NEAR(background_density(filled({90, 60, 30}, false, false), belongs, 1) * 8 * 90 * 60 * 30, 0.887,
              0.05);
}

TEST(Background, OfAFewIsWhatOneThoughtBefore) {
  const smlm::LocalisationTable t = filled({90, 90, 90}, true, false);
  EXPECT_EQ(background_density(
                t, [](std::size_t row) { return row < 5 ? 1 : 0; }, 0.125),
            0.125);
  EXPECT_EQ(background_density(
                t, [](std::size_t row) { return row < 4000 ? 0 : 1; }, 0.125),
            0.125)
      << "all at one place";
}

}  // namespace
}  // namespace polar::results
