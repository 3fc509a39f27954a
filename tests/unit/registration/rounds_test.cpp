#include "registration/rounds.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {
namespace {

// Views of twelve sites, each with its true pose and the template that belongs to them.
struct Scene {
  Views views;
  RoundState state;

  Scene() {
    state.mixture.centre = Eigen::Matrix3Xf::Zero(3, 12);
    state.mixture.weight = Eigen::VectorXf::Constant(12, 1.0f / 12);
    state.mixture.outlier_fraction = 0.05, state.mixture.outlier_density = 0.07;
    KeyedRandom place(4, 0, 1);
    for (int k = 0; k < 12; ++k) state.mixture.centre.col(k) = place.direction().cast<float>();
    const Eigen::Matrix3Xf sites = state.mixture.centre;
    sort_into_blocks(state.mixture);
    for (std::uint64_t i = 0; i < 20; ++i) {
      KeyedRandom random(4, i, 2);
      const Pose pose{random.rotation(), {0, 0, 0}};
      View view;
      view.points.resize(3, 80);
      for (Eigen::Index j = 0; j < 80; ++j) {
        Eigen::Vector3d x = sites.col(static_cast<Eigen::Index>(random.below(12))).cast<double>();
        for (int a = 0; a < 3; ++a) x[a] += 0.05 * random.normal();
        view.points.col(j) = (pose.inverse() * x).cast<float>();
      }
      view.covariance.assign(80, {0.0025f, 0, 0.0025f, 0, 0, 0.0025f});
      views.view.push_back(view);
      state.pose.push_back(pose);
    }
    state.margin.assign(20, 1);
  }
};

TEST(SearchMisfits, findsAViewWhoseCentreIsFarOff) {
  Scene scene;
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
