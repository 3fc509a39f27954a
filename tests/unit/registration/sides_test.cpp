#include "registration/sides.hpp"

#include <gtest/gtest.h>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {
namespace {

constexpr std::size_t kViews = 40;
constexpr Eigen::Index kLocalisations = 250;
constexpr float kReach = 0.35f;  // of a view beyond the middle
const Pose kTurn{so3_exp({0, 0, kPi}), Eigen::Vector3d::Zero()};

// A wedge with a ridge along one side, faint in the middle.
Mixture ridged_wedge() {
  Mixture wedge;
  wedge.centre.resize(3, 33), wedge.weight.resize(33);
  for (int k = 0; k < 11; ++k) {
    const float z = 0.2f * static_cast<float>(k) - 1;
    const float half_width = 0.3f - 0.2f * z;
    wedge.centre.middleCols<3>(3 * k) << half_width, -half_width, 0, 0, 0, 0.35f, z, z, z;
    wedge.weight.segment<3>(3 * k) << 1, 1, std::abs(z) < 0.5f ? 0.3f : 1.0f;
  }
  wedge.weight /= wedge.weight.sum();
  wedge.outlier_fraction = 0.05, wedge.outlier_density = 0.07;
  return wedge;
}

// Views with even numbers show the upper part, the others the lower one, each more than half.
struct WedgeInParts {
  Views views;
  RoundState state;
  std::vector<Pose> truth;

  WedgeInParts() {
    const Mixture wedge = ridged_wedge();
    for (std::uint64_t i = 0; i < kViews; ++i) {
      KeyedRandom random(7, i, 2);
      const float side = i % 2 == 0 ? 1.0f : -1.0f;
      truth.push_back({random.rotation(), Eigen::Vector3d::Zero()});
      View view;
      view.points.resize(3, kLocalisations);
      for (Eigen::Index j = 0; j < kLocalisations;) {
        const auto k = static_cast<Eigen::Index>(random.below(33));
        const double kept = random.uniform();
        if (side * wedge.centre(2, k) < -kReach || kept > 33 * static_cast<double>(wedge.weight[k])) continue;
        Eigen::Vector3d x = wedge.centre.col(k).cast<double>();
        for (int a = 0; a < 3; ++a) x[a] += 0.04 * random.normal();
        view.points.col(j++) = (truth.back().inverse() * x).cast<float>();
      }
      view.covariance.assign(kLocalisations, {0.0016f, 0, 0, 0.0016f, 0, 0.0016f});
      views.view.push_back(view);
    }
    state.pose = truth;
    state.mixture = wedge;
    sort_into_blocks(state.mixture);
    state.width = 0.05;
  }

  // The lower views turned, and the template that this gives: the ridge on both sides.
  void turn_the_lower_views() {
    for (std::size_t i = 1; i < kViews; i += 2) state.pose[i] = kTurn * truth[i];
    Mixture both = ridged_wedge();
    for (Eigen::Index k = 0; k < both.size(); ++k)
      if (both.centre(2, k) < 0)
        both.centre.col(k) = (kTurn * both.centre.col(k).cast<double>().eval()).cast<float>();
    state.mixture = both;
    sort_into_blocks(state.mixture);
  }

  // Views that lie as the first one does.
  std::size_t alike() const {
    const Eigen::Matrix3d global = state.pose[0].rotation * truth[0].rotation.transpose();
    std::size_t count = 0;
    for (std::size_t i = 0; i < kViews; ++i)
      count += geodesic_angle(state.pose[i].rotation, global * truth[i].rotation) < 0.2;
    return count;
  }
};

TEST(TurnSide, bringsTheCropsOfTheTwoSidesTogether) {
  WedgeInParts scene;
  scene.turn_the_lower_views();
  ASSERT_EQ(scene.alike(), kViews / 2);
  const Problems problems = make_problems(scene.views, 1);
  EXPECT_EQ(turn_side(problems.plain, scene.state), problems.plain.all);
  EXPECT_EQ(scene.alike(), kViews);
}

TEST(TurnSide, leavesCropsThatLieRightAlone) {
  WedgeInParts scene;
  const Problems problems = make_problems(scene.views, 1);
  EXPECT_TRUE(turn_side(problems.plain, scene.state).empty());
  EXPECT_EQ(scene.alike(), kViews);
}

}  // namespace
}  // namespace polar
