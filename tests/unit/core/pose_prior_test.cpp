#include "polar/core/pose_prior.hpp"

#include <gtest/gtest.h>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"

namespace polar {
namespace {

Eigen::Matrix3d tilted(double deg) {
  return so3_exp({0, 0, 1}) * so3_exp({deg * kRadiansPerDegree, 0, 0}) * so3_exp({0, 0, 2});
}

TEST(PosePrior, AllowsWhatItsReachHolds) {
  const PosePrior none, upright{10 * kRadiansPerDegree, false}, either{10 * kRadiansPerDegree, true};
  EXPECT_TRUE(none.allows(tilted(130)));
  EXPECT_TRUE(upright.allows(tilted(25)));
  EXPECT_FALSE(upright.allows(tilted(27)));
  EXPECT_FALSE(upright.allows(tilted(155)));
  EXPECT_TRUE(either.allows(tilted(155)));
  EXPECT_FALSE(either.allows(tilted(153)));
}

TEST(PosePrior, UnderAGroupOneImageIsEnough) {
  const PosePrior upright{10 * kRadiansPerDegree, false};
  EXPECT_FALSE(upright.allows(tilted(155), symmetry_rotations("C8")));
  EXPECT_TRUE(upright.allows(tilted(155), symmetry_rotations("D8")));
  EXPECT_FALSE(upright.allows(tilted(140), symmetry_rotations("D8")));
}

TEST(PosePrior, ItsShareIsThatOfRandomOrientations) {
  for (const PosePrior& prior : {PosePrior{}, PosePrior{0.3, false}, PosePrior{0.3, true}}) {
    KeyedRandom random(1, 0, 1);
    const int all = 20000;
    int allowed = 0;
    for (int i = 0; i < all; ++i) allowed += prior.allows(random.rotation());
    const double error = std::sqrt(prior.share() * (1 - prior.share()) / all);
    EXPECT_NEAR(static_cast<double>(allowed) / all, prior.share(), 4 * error + 1e-12);
  }
}

}  // namespace
}  // namespace polar
