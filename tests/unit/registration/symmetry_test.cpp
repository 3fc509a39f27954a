#include "polar/registration/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/registration/register.hpp"
#include "registration/anneal/soft_poses.hpp"
#include "registration/symmetry/harmonics.hpp"
#include "registration/symmetry/relaxation.hpp"
#include "registration/symmetry/self_similarity.hpp"
#include "registration/symmetry/symmetry_frame.hpp"
#include "scene.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

// The density of a structure's sites, moved by `frame`.
DensityGrid density_of(const Eigen::Matrix3Xd& sites, const Pose& frame) {
  LookupPoints points;
  for (Eigen::Index k = 0; k < sites.cols(); ++k)
    points.add((frame * Eigen::Vector3d(sites.col(k))).cast<float>());
  points.pad();
  VoxelCounts counts(VoxelFrame(1.8, 0.06, false));
  counts.add(points, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(), 1);
  DensityGrid out(counts);
  out.blur(0.08);
  return out;
}

TEST(BestFrame, findsAxisAndCentreOfTheGroupThatIsThere) {
  const Pose frame{so3_exp({0.6, -0.4, 0.3}), {0.1, -0.05, 0.12}};
  for (const auto& [group, sites] :
       std::vector<std::pair<std::string, int>>{{"C3", 5}, {"C8", 2}, {"D8", 1}, {"T", 2}}) {
    const SelfSimilarity similarity(density_of(orbit_structure(group, sites, 21), frame), 0.05);
    const SymmetryFrame f = best_frame(similarity, group, 0.5);
    EXPECT_GT(f.similarity, 0.7) << group;
    if (group[0] == 'T') continue;
    const Eigen::Vector3d axis = f.canonical_from_template.rotation.row(2).transpose();
    EXPECT_GT(std::abs(axis.dot(frame.rotation.col(2))), std::cos(0.06)) << group;
  }
}

TEST(BestFrame, ofAGroupThatIsNotThereIsDissimilar) {
  const SelfSimilarity similarity(density_of(orbit_structure("none", 20, 31), {}), 0.05);
  for (const char* group : {"C2", "C5", "D3", "T"})
    EXPECT_LT(best_frame(similarity, group, 0).similarity, 0.5);
}

std::vector<SoftPose> about_axis(const std::vector<Pose>& truth, std::uint64_t seed) {
  std::vector<SoftPose> out;
  for (std::size_t i = 0; i < truth.size(); ++i) {  // the turn about the axis is unknown
    const Eigen::Matrix3d turn = so3_exp({0, 0, 6.28318 * KeyedRandom(seed, i, 9).uniform()});
    out.push_back({(turn * truth[i].rotation).cast<float>(), Eigen::Vector3f::Zero()});
  }
  return out;
}

TEST(AxialHarmonics, nameTheOrderWhateverTheTurnsAboutTheAxis) {
  for (const int order : {5, 8}) {
    const Scene scene(orbit_structure("C" + std::to_string(order), 2, 22), 60, 0.5, 5, 6);
    const Problems p = make_problems(scene.views, {}, 1);
    const auto found = axial_harmonics(p.plain, {}, about_axis(scene.pose, 3), p.plain.all);
    EXPECT_EQ(found.front().order, order);
    EXPECT_GT(found.front().significance, 5);
    for (const AxialHarmonic& h : found) {
      const double most = h.order < order ? 3 : INFINITY;
      EXPECT_LT(h.significance, most) << h.order;
    }
  }
}

TEST(AlignAzimuths, putsTheSitesOfAllViewsOnEachOther) {
  const Scene scene(orbit_structure("C8", 1, 22), 20, 0.6, 5, 6);
  const Problems p = make_problems(scene.views, {}, 1);
  std::vector<SoftPose> pose = about_axis(scene.pose, 3);
  align_azimuths(p.plain, 8, p.plain.all, pose);
  std::vector<double> phase;
  for (std::size_t i = 0; i < pose.size(); ++i) {
    const Eigen::Matrix3d residual = pose[i].rotation.cast<double>() * scene.pose[i].rotation.transpose();
    phase.push_back(8 * std::atan2(residual(1, 0), residual(0, 0)));
  }
  for (const double a : phase) EXPECT_GT(std::cos(a - phase[0]), 0.8);
}

// A symmetric template of a ring of eight under poses that are right up to the ring's turns.
Relaxation relaxed_ring(bool complete) {
  Eigen::Matrix3Xd ring = orbit_structure("C8", 2, 22);  // the units' first sites, then their second ones
  Mixture m;
  m.centre = ring.cast<float>();
  m.weight = Eigen::VectorXf::Constant(16, 0.0625f);
  if (!complete) ring.col(0) = ring.col(1), ring.col(8) = ring.col(9);
  const Scene scene(ring, 60, 0.9, 5, 6);
  const Problems p = make_problems(scene.views, {}, 1);
  Fit fit;
  fit.mixture = m;
  fit.noise.width = 0.03;
  fit.group = symmetry_rotations("C8");
  KeyedRandom random(4, 0, 1);
  for (const Pose& pose : scene.pose)
    fit.pose.push_back(Pose{fit.group[random.below(8)], Eigen::Vector3d::Zero()} * pose);
  return relaxed(p.plain, {}, fit);
}

TEST(Relaxation, findsTheUnitThatEveryViewLacks) {
  const Relaxation r = relaxed_ring(false);
  EXPECT_TRUE(r.gain.better_by(3)) << r.gain.gain << " +- " << r.gain.standard_error;
  EXPECT_TRUE(r.fit.group.empty());
  const Eigen::VectorXf& w = r.fit.mixture.weight;
  Eigen::Index gap = 0;
  w.head(8).minCoeff(&gap);
  for (Eigen::Index k = 0; k < 16; ++k)
    EXPECT_TRUE(k % 8 == gap ? w[k] < 0.01f : w[k] > 0.05f) << k << ": " << w[k];
}

TEST(Relaxation, doesNotGainWhereLabelsAreMissingAtRandom) {
  const Relaxation r = relaxed_ring(true);
  EXPECT_FALSE(r.gain.better_by(2)) << r.gain.gain << " +- " << r.gain.standard_error;
}

Registration registered(const Scene& scene, const std::string& symmetry) {
  RegistrationOptions options;
  options.starts = {"random"};
  options.symmetry = symmetry;
  Progress silent;
  return register_views(scene.views, options, silent);
}

std::vector<Eigen::Matrix3d> rotations(const Registration& r) {
  std::vector<Eigen::Matrix3d> out;
  for (const RegisteredView& v : r.view) out.push_back(v.template_from_view.rotation);
  return out;
}

TEST(AutoSymmetry, findsTheGroupOfHalfLabelledRings) {
  Eigen::Matrix3Xd rings = orbit_structure("D8", 1, 2);
  rings.row(2) *= 0.35 / rings.row(2).cwiseAbs().maxCoeff();
  const Scene scene(rings, 60, 0.6, 5, 6);
  const Registration r = registered(scene, "auto");
  ASSERT_TRUE(r.symmetry);
  EXPECT_EQ(r.symmetry->group, "D8");
  EXPECT_TRUE(r.symmetry->in_use);
  ASSERT_TRUE(r.other);
  EXPECT_EQ(r.other->group, "C1");
  EXPECT_LT(r.other->gain, 0);
  EXPECT_EQ(r.verdict, Verdict::found) << r.verdict_reason;
  EXPECT_GT(share_right(rotations(r), scene.pose, "D8", 0.17), 0.9);
}

TEST(AutoSymmetry, anAsymmetricStructureStaysWithout) {
  const Scene scene(orbit_structure("none", 14, 33), 40, 0.8, 5, 6);
  const Registration r = registered(scene, "auto");
  ASSERT_TRUE(r.symmetry);
  EXPECT_TRUE(r.symmetry->group == "C1" || !r.symmetry->in_use) << r.symmetry->group;
  EXPECT_GT(share_right(rotations(r), scene.pose, "none", 0.17), 0.9);
}

TEST(AutoSymmetry, aWrongOrderThatIsAskedForIsUsedAndCalledWorse) {
  Eigen::Matrix3Xd rings = orbit_structure("D8", 1, 2);
  rings.row(2) *= 0.35 / rings.row(2).cwiseAbs().maxCoeff();
  const Scene scene(rings, 60, 0.6, 5, 6);
  const Registration r = registered(scene, "C7");
  EXPECT_EQ(r.symmetry->group, "C7");
  EXPECT_TRUE(r.symmetry->asked);
  EXPECT_TRUE(std::any_of(r.warnings.begin(), r.warnings.end(), [](const std::string& w) {
    return w.find("C7 explains localisations kept apart worse") != std::string::npos;
  }));
}

TEST(AutoSymmetry, noneForbidsIt) {
  const Scene scene(orbit_structure("C4", 3, 2), 20, 0.9, 5, 6);
  const Registration r = registered(scene, "none");
  EXPECT_FALSE(r.symmetry);
  EXPECT_FALSE(r.other);
}

TEST(Symmetry, inThePlaneOnlyTurnsAboutZCanBeAskedFor) {
  const Scene scene(orbit_structure("C4", 2, 2, true), 10, 1, 5, 6, true);
  EXPECT_THROW(registered(scene, "D4"), smlm::Error);
}

}  // namespace
}  // namespace polar
