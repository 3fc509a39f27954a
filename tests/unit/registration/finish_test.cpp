#include "registration/finish.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"
#include "polar/fusion/calibration.hpp"

namespace polar {
namespace {

// Few localisations all over a sphere, at known poses.
struct Sphere {
  Views views;
  std::vector<Pose> pose;

  Sphere() {
    for (std::uint64_t i = 0; i < 40; ++i) {
      KeyedRandom random(5, i, 1);
      Pose p;
      p.rotation = random.rotation();
      View view;
      view.points.resize(3, 50);
      for (Eigen::Index j = 0; j < 50; ++j) {
        Eigen::Vector3d x = random.direction();
        for (int a = 0; a < 3; ++a) x[a] += 0.05 * random.normal();
        view.points.col(j) = (p.inverse() * x).cast<float>();
      }
      view.covariance.assign(50, {0.0025f, 0, 0.0025f, 0, 0, 0.0025f});
      views.view.push_back(view);
      pose.push_back(p);
    }
  }
};

double held_out(const Problem& problem, const RoundState& state, const NoiseModel& noise) {
  return calibrate(problem.views, problem.axes, problem.held_out, state.mixture, state.pose, noise)
      .log_likelihood;
}

TEST(CalibrateAndFuse, stopsBeforeATemplateOfFewLocalisationsClumps) {
  const Sphere sphere;
  const Problems problems = make_problems(sphere.views, 1);
  RoundState first;
  first.pose = sphere.pose;
  fuse_anew(problems.thinned, RoundOptions{}, problems.thinned.all, first);
  NoiseModel noise;
  noise.width = 0.09;
  RoundState state = first;
  const NoiseModel after = calibrate_and_fuse(problems.thinned, 8, noise, state);
  EXPECT_GT(held_out(problems.thinned, state, after), held_out(problems.thinned, first, noise) - 0.05);
  EXPECT_LT(after.lateral_extra, 0.15);
}

}  // namespace
}  // namespace polar
