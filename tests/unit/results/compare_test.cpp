#include "polar/results/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

struct Tables {
  std::vector<PoseRow> estimate, truth;
};

// Estimates that are the truth, moved as a whole, turned by a random element of the group each, with a
// rotation error of exactly `error_deg` about a random axis; the first `wrong` are anything.
Tables make(std::size_t n, const std::string& symmetry, double error_deg, std::size_t wrong) {
  Tables t;
  const auto group = symmetry_rotations(symmetry);
  KeyedRandom random(7, 0, 0);
  const Pose global{random.rotation(), {10, -20, 30}};
  for (std::size_t i = 0; i < n; ++i) {
    PoseRow row;
    row.particle = std::to_string(i);
    row.accepted = true;
    const Pose truth{random.rotation(), 100 * random.direction()};
    const Pose turned{
        so3_exp(error_deg * kRadiansPerDegree * random.direction()) * group[random.below(group.size())],
        Eigen::Vector3d::Zero()};
    row.template_from_view = truth;
    t.truth.push_back(row);
    row.template_from_view = global * turned * truth;
    if (i < wrong) row.template_from_view = Pose{random.rotation(), 100 * random.direction()};
    t.estimate.push_back(row);
  }
  return t;
}

TEST(ComparePoses, ExactPosesAreExact) {
  for (const char* symmetry : {"none", "C8", "D8", "T", "O", "I"}) {
    const Tables t = make(30, symmetry, 0, 0);
    CompareOptions options;
    options.symmetry = symmetry;
    const Comparison c = compare_poses(t.estimate, t.truth, options);
    EXPECT_LT(c.median_pair_deg, 1e-5) << symmetry;
    EXPECT_EQ(c.recall.front(), 1.0) << symmetry;
    EXPECT_LT(c.median_translation_nm, 1e-6) << symmetry;
    EXPECT_LT(c.median_rotation_deg, 1e-5) << symmetry;
    EXPECT_EQ(c.n_pairs, 30u * 29 / 2);
    EXPECT_EQ(c.n_aligned, 30u);
  }
}

TEST(ComparePoses, WithoutTheSymmetryTurnedParticlesAreWrong) {
  const Tables t = make(60, "C8", 0, 0);
  const Comparison c = compare_poses(t.estimate, t.truth, {});
  EXPECT_NEAR(c.recall.front(), 1.0 / 8, 0.05);
}

TEST(ComparePoses, GlobalMotionSurvivesWrongParticles) {
  const Tables t = make(100, "D8", 1.0, 40);
  CompareOptions options;
  options.symmetry = "D8";
  const Comparison c = compare_poses(t.estimate, t.truth, options);
  std::size_t right = 0;
  for (std::size_t i = 40; i < 100; ++i) right += c.particle[i].rotation_deg < 1.5 ? 1 : 0;
  EXPECT_EQ(right, 60u);
  EXPECT_LT(c.particle[99].translation_nm, 1.0);
}

TEST(ComparePoses, RecallCountsPairsAndMissingPosesAreWrong) {
  Tables t = make(20, "none", 0, 10);
  const double right_pairs = 10.0 * 9 / 2;
  const Comparison all = compare_poses(t.estimate, t.truth, {});
  EXPECT_NEAR(all.recall.front(), right_pairs / 190, 0.011);  // two of the wrong ones may agree by chance
  for (std::size_t i = 0; i < 10; ++i) t.estimate[i].template_from_view.reset();
  const Comparison some = compare_poses(t.estimate, t.truth, {});
  EXPECT_EQ(some.n_compared, 10u);
  EXPECT_EQ(some.recall.front(), 1.0);
  EXPECT_NEAR(some.recall_of_truth.front(), right_pairs / 190, 1e-12);
}

TEST(ComparePoses, ManyParticlesAreSampledAndAgree) {
  const Tables t = make(2200, "none", 2.0, 0);
  const Comparison c = compare_poses(t.estimate, t.truth, {});
  EXPECT_TRUE(c.sampled);
  // Two errors of 2 degrees about random axes differ by up to 4, by 2 sqrt 2 in the median.
  EXPECT_NEAR(c.median_pair_deg, 2 * std::sqrt(2.0), 0.03);
  EXPECT_EQ(c.cdf[3], 1.0);
}

TEST(ComparePoses, FaultsOfTheTables) {
  Tables t = make(3, "none", 0, 0);
  t.estimate[1].particle = t.estimate[0].particle;
  EXPECT_THROW(compare_poses(t.estimate, t.truth, {}), smlm::Error);
  t.estimate.resize(1);
  EXPECT_THROW(compare_poses(t.estimate, t.truth, {}), smlm::Error);
  CompareOptions options;
  options.symmetry = "C0";
  EXPECT_THROW(compare_poses(t.truth, t.truth, options), smlm::Error);
}

TEST(SymmetryGroup, Orders) {
  const std::pair<const char*, std::size_t> orders[] = {{"none", 1}, {"C1", 1}, {"C9", 9}, {"D8", 16},
                                                        {"T", 12},   {"O", 24}, {"I", 60}};
  for (const auto& [name, order] : orders) EXPECT_EQ(symmetry_rotations(name).size(), order) << name;
  for (const char* wrong : {"", "C", "C0", "D-1", "C3x", "S4", "C361"})
    EXPECT_THROW(symmetry_rotations(wrong), smlm::Error) << wrong;
}

}  // namespace
}  // namespace polar
