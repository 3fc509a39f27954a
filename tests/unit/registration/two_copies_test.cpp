#include "registration/two_copies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"
#include "site_scene.hpp"

namespace polar {
namespace {

constexpr int kFirst = 11;  // views of the first copy

// Nine of the twenty views, and a copy of the template for them, turned by half a turn.
struct Doubled : SiteScene {
  std::vector<Pose> truth = state.pose;

  Doubled() {
    const Pose turn{so3_exp({0, 0, kPi}), {0, 0, 0}};
    for (std::size_t i = kFirst; i < 20; ++i) state.pose[i] = turn * state.pose[i];
    Mixture both = state.mixture;
    both.centre.resize(3, 24), both.weight.resize(24);
    both.centre << state.mixture.centre, turn.rotation.cast<float>() * state.mixture.centre;
    both.weight << state.mixture.weight * (kFirst / 20.0f), state.mixture.weight * (1 - kFirst / 20.0f);
    sort_into_blocks(both);
    state.mixture = both;
    state.width = 0.05;
  }
};

TEST(TwoCopies, theViewsOfTheLargerOneAreFound) {
  Doubled scene;
  const Problems problems = make_problems(scene.views, 1);
  std::vector<int> larger(kFirst);
  std::iota(larger.begin(), larger.end(), 0);
  EXPECT_EQ(views_of_one_copy(problems.plain, scene.state), larger);
}

TEST(TwoCopies, aViewWithoutLocalisationsIsLeftAside) {
  Doubled scene;
  scene.views.view[0].points.resize(3, 0), scene.views.view[0].covariance.clear();
  const Problems problems = make_problems(scene.views, 1);
  const std::vector<int> found = views_of_one_copy(problems.plain, scene.state);
  for (int i = 1; i < kFirst; ++i)
    EXPECT_EQ(std::count(found.begin(), found.end(), i), std::count(found.begin(), found.end(), 1)) << i;
  EXPECT_NE(std::count(found.begin(), found.end(), 1), std::count(found.begin(), found.end(), 19));
}

TEST(TwoCopies, oneCopyIsNotSplit) {
  SiteScene scene;
  scene.state.width = 0.05;
  const Problems problems = make_problems(scene.views, 1);
  EXPECT_TRUE(views_of_one_copy(problems.plain, scene.state).empty());
}

TEST(TwoCopies, roundsFromOneCopyBringAllViewsTogether) {
  Doubled scene;
  const Problems problems = make_problems(scene.views, 1);
  const RoundOptions options;
  RoundState state = scene.state;
  fuse_anew(problems.plain, options, views_of_one_copy(problems.plain, scene.state), state);
  Progress silent;
  Checkpoint nothing;
  ASSERT_TRUE(
      run_rounds(problems.plain, search_grid(options.rotations, false), options, silent, nothing, state));
  const Eigen::Matrix3d global = state.pose[0].rotation * scene.truth[0].rotation.transpose();
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_LT(geodesic_angle(state.pose[i].rotation, global * scene.truth[i].rotation), 0.15) << i;
}

TEST(TurnBack, bringsTheViewsOfTheTurnedCopyBack) {
  Doubled scene;
  const Problems problems = make_problems(scene.views, 1);
  RoundState state = scene.state;
  EXPECT_EQ(turn_back(problems.plain, state), problems.plain.all);
  const Eigen::Matrix3d global = state.pose[0].rotation * scene.truth[0].rotation.transpose();
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_LT(geodesic_angle(state.pose[i].rotation, global * scene.truth[i].rotation), 0.1) << i;
}

TEST(TurnBack, leavesOneCopyAlone) {
  SiteScene scene;
  scene.state.width = 0.05;
  const Problems problems = make_problems(scene.views, 1);
  RoundState state = scene.state;
  EXPECT_TRUE(turn_back(problems.plain, state).empty());
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(state.pose[i].rotation, scene.state.pose[i].rotation);
}

// Where the structure has the half turn, either pose is right and pairs prefer none.
TEST(TurnBack, leavesASymmetricStructureAlone) {
  Doubled scene;
  const Pose turn{so3_exp({0, 0, kPi}), {0, 0, 0}};
  for (std::size_t i = 0; i < 20; ++i) {  // every second localisation on the other half
    const Pose& pose = scene.truth[i];
    for (Eigen::Index j = 0; j < 80; j += 2) {
      const Eigen::Vector3d x = scene.views.view[i].points.col(j).cast<double>();
      scene.views.view[i].points.col(j) = (pose.inverse() * (turn * (pose * x))).cast<float>();
    }
  }
  const Problems problems = make_problems(scene.views, 1);
  RoundState state = scene.state;
  EXPECT_TRUE(turn_back(problems.plain, state).empty());
}

}  // namespace
}  // namespace polar
