#include "polar/fusion/orbits.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fixture.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/fusion/maximisation.hpp"

namespace polar {
namespace {

constexpr float kRounding = 2e-6f;  // of single-precision centres of size 1

float worst_image(const Mixture& m, const RotationGroup& group) {
  float worst = 0;
  for (const Eigen::Matrix3d& g : group)
    for (Eigen::Index k = 0; k < m.size(); ++k)
      worst =
          std::max(worst, std::sqrt((m.centre.colwise() - Eigen::Vector3f(g.cast<float>() * m.centre.col(k)))
                                        .colwise()
                                        .squaredNorm()
                                        .minCoeff()));
  return worst;
}

TEST(Symmetrised, isClosedUnderTheGroupAndKeepsTheWeight) {
  for (const char* name : {"C2", "C8", "D8", "T", "O", "I", "C24"}) {
    const RotationGroup group = symmetry_rotations(name);
    const Mixture m = symmetrised(fixture::random_mixture(12, 5), group, 0.05);
    EXPECT_LT(worst_image(m, group), kRounding) << name;
    EXPECT_NEAR(m.weight.sum(), 1, 1e-5) << name;
    EXPECT_GE(static_cast<std::size_t>(m.size()), group.size()) << name;
  }
}

TEST(Symmetrised, copiesOfOneSiteBecomeOneAndASiteOnAnAxisHasFewerImages) {
  const RotationGroup t = symmetry_rotations("T");
  Mixture m;
  m.centre.resize(3, 4);  // a tetrahedron, each vertex a little off its three-fold axis
  m.centre << 0.51f, -0.49f, -0.50f, 0.50f, 0.50f, -0.50f, 0.51f, -0.51f, 0.49f, 0.50f, -0.50f, -0.50f;
  m.weight = Eigen::VectorXf::Constant(4, 0.25f);
  const Mixture s = symmetrised(m, t, 0.2);
  ASSERT_EQ(s.size(), 4);
  EXPECT_NEAR(s.centre.cwiseAbs().minCoeff(), s.centre.cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Symmetrised, manyFoldsAreNotPulledOntoTheAxis) {
  const RotationGroup c60 = symmetry_rotations("C60");  // images nearer than the merging distance
  Mixture m;
  m.centre = Eigen::Vector3f(1, 0, 0.2f);
  m.weight = Eigen::VectorXf::Constant(1, 1.0f);
  const Mixture s = symmetrised(m, c60, 0.2);
  EXPECT_EQ(s.size(), 60);
  EXPECT_GT(s.centre.topRows(2).colwise().norm().minCoeff(), 0.99f);
}

TEST(Maximise, underAGroupEqualsViewsThatEnterOnceForEveryElement) {
  const RotationGroup group = symmetry_rotations("D3");
  const Mixture start = symmetrised(fixture::random_mixture(4, 8), group, 0.01);
  Views views;
  std::vector<Pose> pose;
  for (std::uint64_t i = 0; i < 6; ++i) {
    pose.push_back(fixture::random_pose(50 + i));
    views.view.push_back(fixture::draw_view(start, pose.back(), 60, 0.05f, 0.12f, 70 + i));
  }
  const std::vector<Eigen::Vector3f> axes(views.view.size(), Eigen::Vector3f::UnitZ());
  NoiseModel noise;
  MaximisationOptions em;
  em.support = false, em.free_weights = true, em.weakest_share = 0;
  Mixture whole = start;
  std::vector<int> which;
  std::vector<Pose> every;
  for (const Eigen::Matrix3d& g : group)
    for (std::size_t i = 0; i < pose.size(); ++i) {
      which.push_back(static_cast<int>(i));
      every.push_back(Pose{g, Eigen::Vector3d::Zero()} * pose[i]);
    }
  maximise(whole, FusionData(views, axes, noise, {}, which), every, em);
  Mixture folded = start;
  em.group = group;
  maximise(folded, FusionData(views, axes, noise), pose, em);
  ASSERT_EQ(whole.size(), folded.size());
  for (Eigen::Index k = 0; k < folded.size(); ++k) {
    Eigen::Index at = 0;
    const float d = (whole.centre.colwise() - folded.centre.col(k)).colwise().norm().minCoeff(&at);
    EXPECT_LT(d, 1e-4f);
    EXPECT_NEAR(whole.weight[at], folded.weight[k], 1e-5);
  }
  EXPECT_LT(worst_image(folded, group), kRounding);
}

}  // namespace
}  // namespace polar
