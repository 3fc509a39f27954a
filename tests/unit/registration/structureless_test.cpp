#include "registration/structureless.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"

namespace polar {
namespace {

// Views of localisations all over a ball (disc) of radius 1.
Views balls(bool planar) {
  Views views;
  views.planar = planar;
  for (std::uint64_t i = 0; i < 50; ++i) {
    KeyedRandom random(2, i, 1);
    View view;
    view.points.resize(3, 400);
    for (Eigen::Index j = 0; j < 400; ++j) {
      const double angle = 2 * kPi * random.uniform();
      const Eigen::Vector3d x = planar ? Eigen::Vector3d(std::sqrt(random.uniform()) *
                                                         Eigen::Vector3d(std::cos(angle), std::sin(angle), 0))
                                       : Eigen::Vector3d(std::cbrt(random.uniform()) * random.direction());
      view.points.col(j) = x.cast<float>();
    }
    view.covariance.assign(400, {1e-4f, 0, 1e-4f, 0, 0, 1e-4f});
    views.view.push_back(view);
  }
  return views;
}

TEST(StructurelessScore, isTheDensityOfABallOrADisc) {
  for (const bool planar : {false, true}) {
    const Views views = balls(planar);
    const double density = planar ? 1 / kPi : 3 / (4 * kPi);
    EXPECT_NEAR(structureless_score(make_problems(views, 1).plain), std::log(density), 0.03) << planar;
  }
}

TEST(ExplainsNoMoreThanACloud, asksForAGainBeyondChance) {
  const Views views = balls(false);
  const Problem problem = make_problems(views, 1).plain;  // about 4,000 judge
  const double cloud = structureless_score(problem);
  EXPECT_TRUE(explains_no_more_than_a_cloud(problem, cloud - 1));
  EXPECT_TRUE(explains_no_more_than_a_cloud(problem, cloud + 0.05));
  EXPECT_FALSE(explains_no_more_than_a_cloud(problem, cloud + 0.12));
}

}  // namespace
}  // namespace polar
