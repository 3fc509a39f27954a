#include "registration/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "polar/core/progress.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/registration/prepare.hpp"
#include "polar/registration/register.hpp"
#include "scattered_structure.hpp"
#include "site_scene.hpp"

namespace polar {
namespace {

std::vector<Pose> random_poses(std::size_t n) {
  std::vector<Pose> pose;
  for (std::size_t i = 0; i < n; ++i) pose.push_back({KeyedRandom(3, i, 1).rotation(), {0.1, 0, 0}});
  return pose;
}

// The same poses in another frame, each off by `error` radians about an axis of its own.
std::vector<Pose> elsewhere(std::vector<Pose> pose, double error) {
  const Pose frame{so3_exp({0.4, -1.1, 2}), {1, 2, 3}};
  for (std::size_t i = 0; i < pose.size(); ++i) {
    pose[i] = frame * pose[i];
    pose[i].rotation = so3_exp(error * KeyedRandom(5, i, 1).direction()) * pose[i].rotation;
  }
  return pose;
}

TEST(Agreement, doesNotDependOnTheFrame) {
  const std::vector<Pose> pose = random_poses(30);
  EXPECT_EQ(agreement(pose, elsewhere(pose, 0)), 1);
  EXPECT_EQ(agreement(pose, elsewhere(pose, 0.1)), 1);
}

TEST(Agreement, countsTheViewsThatMovedTogether) {
  const std::vector<Pose> pose = random_poses(20);
  std::vector<Pose> other = elsewhere(pose, 0.02);
  for (std::size_t i = 0; i < 5; ++i)
    other[i].rotation = so3_exp({0, 0, 1.0 + 0.3 * double(i)}) * other[i].rotation;
  EXPECT_DOUBLE_EQ(agreement(pose, other), 0.75);
}

TEST(Agreement, ofUnrelatedPosesIsChance) {
  std::vector<Pose> other;
  for (std::size_t i = 0; i < 40; ++i) other.push_back({KeyedRandom(9, i, 2).rotation(), {0, 0, 0}});
  EXPECT_LT(agreement(random_poses(40), other), 0.15);
  EXPECT_EQ(agreement({}, {}), 0);
}

TEST(RegisterViews, endsTheCompetitionWhereRandomStartsAgree) {
  const SiteScene scene;
  Progress silent;
  const Registration r = register_views(scene.views, {}, silent);
  EXPECT_GE(r.agreement, 0.95);
  for (const StartReport& s : r.starts)
    EXPECT_TRUE(s.name.compare(0, 7, "random ") == 0 || s.name == "without strands") << s.name;
  std::vector<Pose> found;
  for (const RegisteredView& view : r.view) found.push_back(view.template_from_view);
  EXPECT_EQ(agreement(found, scene.state.pose), 1);
}

TEST(RegisterViews, registersAWinnerThatExpectedStrandsOnceMoreWithoutThem) {
  SimulationOptions o = sixteen_particles(400);
  o.outliers = "strands";
  o.outlier_fraction = 0.4;
  const Simulation s = simulate(scattered_structure(80), o);
  Progress silent;
  const Registration r = register_views(prepare_views(smlm::group_particles(s.table)), {}, silent);
  ASSERT_GT(r.starts.size(), 1u);
  EXPECT_EQ(r.starts.back().name, "without strands");
  double best = -1e300, won = 0;
  for (const StartReport& start : r.starts) {
    if (start.final_held_out_log_likelihood != 0) best = std::max(best, start.final_held_out_log_likelihood);
    if (start.won) won = start.final_held_out_log_likelihood;
  }
  EXPECT_EQ(won, best);
}

TEST(RegisterViews, runsEveryStartWhereViewsAreTooFewToAgree) {
  SiteScene scene;
  scene.views.view.resize(8);
  Progress silent;
  const Registration r = register_views(scene.views, {}, silent);
  EXPECT_EQ(r.agreement, 0);
  for (const char* name : {"polar", "imaged"})
    EXPECT_TRUE(std::any_of(r.starts.begin(), r.starts.end(), [&](const StartReport& s) {
      return s.name == name;
    })) << name;
}

}  // namespace
}  // namespace polar
