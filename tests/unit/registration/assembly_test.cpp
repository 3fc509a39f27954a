#include "registration/assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/registration/prepare.hpp"
#include "polar/registration/register.hpp"
#include "scattered_structure.hpp"

namespace polar {
namespace {

std::vector<Pose> random_poses(std::size_t n) {
  std::vector<Pose> pose;
  for (std::size_t i = 0; i < n; ++i) {
    KeyedRandom random(7, i, 1);
    pose.push_back({random.rotation(), random.direction()});
  }
  return pose;
}

Joint joint(const std::vector<Pose>& pose, std::size_t first, std::size_t second, double evidence) {
  return {first, second, {pose[first].inverse() * pose[second], evidence}};
}

double disagreement(const std::vector<Pose>& a, const std::vector<Pose>& b, std::size_t i, std::size_t j) {
  const Pose x = a[i].inverse() * a[j], y = b[i].inverse() * b[j];
  return geodesic_angle(x.rotation, y.rotation) + (x.translation - y.translation).norm();
}

TEST(SpanningPoses, followTheSurestJoints) {
  const std::vector<Pose> truth = random_poses(5);
  std::vector<Joint> joints = {joint(truth, 3, 4, 2), joint(truth, 0, 2, 5), joint(truth, 1, 3, 4),
                               joint(truth, 2, 4, 3)};
  Joint wrong = joint(truth, 0, 1, 1);  // less sure than the way round
  wrong.match.first_from_second.rotation = so3_exp({1, 1, 1}) * wrong.match.first_from_second.rotation;
  joints.insert(joints.begin(), wrong);
  const std::vector<Pose> pose = spanning_poses(5, joints);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_LT(disagreement(pose, truth, 0, i), 1e-9) << i;
  EXPECT_TRUE(pose[0].rotation.isIdentity(1e-12));
}

TEST(SpanningPoses, leaveUnreachedViewsAtRest) {
  const std::vector<Pose> truth = random_poses(4);
  const std::vector<Pose> pose = spanning_poses(4, {joint(truth, 0, 1, 2), joint(truth, 2, 3, 9)});
  EXPECT_LT(disagreement(pose, truth, 0, 1), 1e-9);
  EXPECT_TRUE(pose[2].rotation.isIdentity(0) && pose[3].rotation.isIdentity(0));
}

// Every joint moves the group that has moved before, about the view that has moved most.
TEST(SpanningPoses, stayRotationsWhereMatchesAreSinglePrecision) {
  constexpr std::size_t kViews = 50;
  const std::vector<Pose> truth = random_poses(kViews);
  std::vector<Joint> joints;
  for (std::size_t i = 0; i + 1 < kViews; ++i) {
    joints.push_back(joint(truth, i, kViews - 1, static_cast<double>(i)));
    Eigen::Matrix3d& rotation = joints.back().match.first_from_second.rotation;
    rotation = rotation.cast<float>().cast<double>();
  }
  const std::vector<Pose> pose = spanning_poses(kViews, joints);
  for (std::size_t i = 0; i < kViews; ++i) {
    EXPECT_TRUE((pose[i].rotation * pose[i].rotation.transpose()).isIdentity(1e-6)) << i;
    EXPECT_LT(disagreement(pose, truth, 0, i), 1e-4) << i;
  }
}

TEST(RegisterViews, assemblesHalvesOfParticles) {
  SimulationOptions o = sixteen_particles(800);
  o.visibility = {0.5, 0.5};
  const Simulation s = simulate(scattered_structure(80), o);
  const Views views = prepare_views(smlm::group_particles(s.table));
  RegistrationOptions options;
  options.starts = {"assembled"};
  Progress silent;
  const Registration r = register_views(views, options, silent);
  ASSERT_EQ(r.starts.size(), 1u);
  EXPECT_EQ(r.starts[0].name, "assembled");
  EXPECT_TRUE(r.starts[0].won);
  int right = 0;
  for (std::size_t i = 0; i < s.particle.size(); ++i)
    for (std::size_t j = i + 1; j < s.particle.size(); ++j) {
      const auto relative = [&](const Pose& a, const Pose& b) {
        return Eigen::Matrix3d(a.rotation.transpose() * b.rotation);
      };
      right += geodesic_angle(relative(r.view[i].template_from_view, r.view[j].template_from_view),
                              relative(s.particle[i].structure_from_view,
                                       s.particle[j].structure_from_view)) < 5 * kRadiansPerDegree;
    }
  EXPECT_GE(right, 114);  // of 120 pairs
}

}  // namespace
}  // namespace polar
