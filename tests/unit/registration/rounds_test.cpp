#include "registration/rounds.hpp"

#include <gtest/gtest.h>

#include "polar/core/so3.hpp"
#include "site_scene.hpp"

namespace polar {
namespace {

TEST(SearchMisfits, findsAViewWhoseCentreIsFarOff) {
  SiteScene scene;
  const std::vector<Pose> truth = scene.state.pose;
  for (Eigen::Index j = 0; j < 80; ++j)
    scene.views.view[7].points.col(j) += Eigen::Vector3f(0.5f, -0.4f, 0.3f);
  scene.state.pose[7].rotation = so3_exp({1, -1, 1}) * scene.state.pose[7].rotation;
  const Problems problems = make_problems(scene.views, 1);
  NoiseModel noise;
  noise.width = 0.03;
  const RoundOptions options;
  EXPECT_EQ(
      search_misfits(problems.plain, search_grid(options.rotations, false), options, noise, scene.state),
      std::vector<std::size_t>{7});
  EXPECT_LT(geodesic_angle(scene.state.pose[7].rotation, truth[7].rotation), 0.1);
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_LT(geodesic_angle(scene.state.pose[i].rotation, truth[i].rotation), 0.1) << i;
}

}  // namespace
}  // namespace polar
