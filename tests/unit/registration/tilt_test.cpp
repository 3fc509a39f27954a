#include "polar/registration/tilt.hpp"

#include <gtest/gtest.h>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {
namespace {

// Views tilted by `tilt_deg` about both axes, half of them upside down, posed to `error_deg`, in a template
// that was turned any way.
std::vector<RegisteredView> tilted(double tilt_deg, double error_deg, int count, int wrong) {
  std::vector<RegisteredView> out;
  KeyedRandom random(3, 1, 1);
  const Eigen::Matrix3d frame = random.rotation();
  const auto two = [&](double deg) {
    return so3_exp(Eigen::Vector3d(random.normal(), random.normal(), 0) * deg * kRadiansPerDegree);
  };
  for (int i = 0; i < count; ++i) {
    RegisteredView v;
    const Eigen::Matrix3d flip = i % 2 == 0 ? Eigen::Matrix3d::Identity() : so3_exp({kPi, 0, 0});
    v.template_from_view.rotation =
        frame * two(error_deg) * two(tilt_deg) * flip * so3_exp({0, 0, 6 * random.uniform()});
    if (i < wrong) v.template_from_view.rotation = random.rotation();
    v.covariance.setZero();
    v.covariance.topLeftCorner<3, 3>() =
        Eigen::Matrix3d::Identity() * std::pow(error_deg * kRadiansPerDegree, 2);
    v.accepted = true;
    out.push_back(v);
  }
  return out;
}

TEST(TiltSpread, IsThatOfTheViewsWithoutTheirPosesErrors) {
  for (const double truth : {5.0, 12.0, 20.0}) {
    const std::optional<TiltSpread> t = tilt_spread(tilted(truth, 5, 1000, 0));
    ASSERT_TRUE(t);
    EXPECT_NEAR(t->std_deg, truth, 0.08 * truth);
    EXPECT_EQ(t->particles, 1000u);
  }
}

TEST(TiltSpread, AFewWrongPosesDoNotWidenIt) {
  EXPECT_NEAR(tilt_spread(tilted(12, 5, 1000, 80))->std_deg, 12, 2);
  EXPECT_FALSE(tilt_spread({}));
}

}  // namespace
}  // namespace polar
