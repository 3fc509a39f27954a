#include "registration/anneal/soft_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/parallel.hpp"
#include "scene.hpp"

namespace polar {
namespace {

constexpr double kRight = 0.26;  // rad

AnnealStage whole(const AnnealOptions& o) {
  return {o.sweeps, o.first_width, o.last_width, o.first_beta, o.last_beta, o.narrowing, true};
}

std::vector<Eigen::Matrix3d> best_of(const SoftState& s) {
  std::vector<Eigen::Matrix3d> out;
  for (const SoftPose& p : s.best) out.push_back(p.rotation.cast<double>());
  return out;
}

TEST(SoftAnnealer, findsAStructureFromRandomPoses) {
  const Scene scene(orbit_structure("none", 10, 7), 30, 0.8, 6, 8);
  const Problems p = make_problems(scene.views, {}, 1);
  const AnnealOptions o;
  const SoftAnnealer annealer(p.plain, p.plain.all, o, {});
  double best = 0;
  for (const std::uint64_t key : {1u, 2u, 3u}) {
    SoftState state = annealer.random_start(key);
    annealer.anneal(whole(o), key, state);
    best = std::max(best, share_right(best_of(state), scene.pose, "none", kRight));
  }
  EXPECT_GT(best, 0.9);
}

TEST(SoftAnnealer, evidenceIsHigherForTheRightPosesThanForRandomOnes) {
  const Scene scene(orbit_structure("none", 10, 7), 30, 0.8, 6, 8);
  const Problems p = make_problems(scene.views, {}, 1);
  const SoftAnnealer annealer(p.plain, p.plain.all, {}, {});
  std::vector<SoftPose> truth;
  for (const Pose& pose : scene.pose) truth.push_back({pose.rotation.cast<float>(), Eigen::Vector3f::Zero()});
  const SoftState right = annealer.from_poses(truth, p.plain.all, 0.06);
  SoftState wrong = annealer.random_start(1);
  annealer.fuse(0.06, wrong);
  EXPECT_TRUE(compare(annealer.judge(wrong, 1), annealer.judge(right, 1)).better_by(3));
}

TEST(SoftAnnealer, aTiltPriorHoldsEveryPose) {
  const Scene scene(orbit_structure("none", 10, 7), 12, 0.8, 6, 8);
  const Problems p = make_problems(scene.views, {}, 1);
  const PosePrior prior{0.1, false};
  const SoftAnnealer annealer(p.plain, p.plain.all, {}, prior);
  SoftState state = annealer.random_start(1);
  annealer.anneal({6, 0.2, 0.1, 0.1, 1, 0.8, true}, 1, state);
  for (const SoftPose& b : state.best) EXPECT_GT(b.rotation(2, 2), std::cos(0.5));
  SoftState ring = state;
  ring.group = symmetry_rotations("D120");  // its asymmetric unit holds none of the grid's upright rotations
  const SoftAnnealer narrow(p.plain, p.plain.all, {}, {1e-4, false});
  narrow.anneal({1, 0.1, 0.1, 1, 1, 0.8, false}, 2, ring);
  for (const SoftPose& b : ring.best) EXPECT_GT(b.rotation(2, 2), std::cos(0.5));
}

TEST(SoftAnnealer, planarPosesStayInThePlane) {
  const Scene scene(orbit_structure("none", 6, 9, true), 12, 1, 6, 8, true);
  const Problems p = make_problems(scene.views, {}, 1);
  const SoftAnnealer annealer(p.plain, p.plain.all, {}, {});
  SoftState state = annealer.random_start(1);
  annealer.anneal({6, 0.2, 0.1, 0.1, 1, 0.8, true}, 1, state);
  for (const auto& samples : state.sample)
    for (const SoftPose& s : samples) {
      EXPECT_NEAR(s.rotation(2, 2), 1, 1e-5);
      EXPECT_EQ(s.translation.z(), 0);
    }
}

TEST(SoftAnnealer, anyNumberOfThreadsGivesTheSameBits) {
  const Scene scene(orbit_structure("none", 10, 7), 80, 0.8, 4, 8);
  const Problems p = make_problems(scene.views, {}, 1);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    const SoftAnnealer annealer(p.plain, p.plain.all, {}, {});
    SoftState state = annealer.random_start(1);
    annealer.anneal({5, 0.2, 0.1, 0.2, 1, 0.8, true}, 1, state);
    return state;
  };
  const SoftState one = run(1), three = run(3);
  EXPECT_EQ(one.density.value(), three.density.value());
  for (std::size_t i = 0; i < one.best.size(); ++i)
    EXPECT_EQ(one.best[i].rotation, three.best[i].rotation) << i;
}

}  // namespace
}  // namespace polar
