#include "polar/registration/symmetry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/registration/register.hpp"
#include "registration/self_similarity.hpp"
#include "registration/symmetry_frame.hpp"
#include "registration/symmetry_stage.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

constexpr double kAxisTolerance = 0.03;  // rad, a half of a search's width at the rim
constexpr double kNoise = 0.04;          // of a localisation

// The orbits of a few random sites.
Eigen::Matrix3Xd structure(const std::string& group, int sites, std::uint64_t seed, bool planar = false) {
  KeyedRandom random(seed, 0, 1);
  const RotationGroup turns = symmetry_rotations(group);
  Eigen::Matrix3Xd out(3, 0);
  for (int s = 0; s < sites; ++s) {
    Eigen::Vector3d x = (0.6 + 0.4 * random.uniform()) * random.direction();
    if (planar) x.z() = 0, x.normalize();
    for (const Eigen::Matrix3d& g : turns) {
      out.conservativeResize(3, out.cols() + 1);
      out.col(out.cols() - 1) = g * x;
    }
  }
  return out;
}

// Views of the structure at known poses, moved by `frame`, and the registered state that goes with them.
struct Registered {
  Views views;
  RoundState state;
  NoiseModel noise;

  Registered(const Eigen::Matrix3Xd& sites, const Pose& frame, std::uint64_t seed, bool planar = false) {
    views.planar = noise.planar = planar;
    noise.width = 0;
    noise.lateral_extra = noise.axial_extra = 0.01;
    for (std::uint64_t i = 0; i < 40; ++i) {
      KeyedRandom random(seed, i, 2);
      Pose pose;
      pose.rotation = planar ? so3_exp({0, 0, 6 * random.uniform()}) : random.rotation();
      View view;
      view.points.resize(3, 120);
      for (Eigen::Index j = 0; j < 120; ++j) {
        const auto k = static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(sites.cols())));
        Eigen::Vector3d x = frame * Eigen::Vector3d(sites.col(k));
        const double a = random.normal(), b = random.normal(), c = random.normal();
        x += kNoise * Eigen::Vector3d(a, b, planar ? 0 : c);
        view.points.col(j) = (pose.inverse() * x).cast<float>();
        view.covariance.push_back(
            {float(kNoise * kNoise), 0, 0, float(kNoise * kNoise), 0, float(kNoise * kNoise)});
      }
      views.view.push_back(view);
      state.pose.push_back(pose);
    }
    state.sites = true;
    state.mixture.centre = ((frame.rotation * sites).colwise() + frame.translation).cast<float>();
    state.mixture.weight = Eigen::VectorXf::Constant(sites.cols(), 1.0f / static_cast<float>(sites.cols()));
    state.mixture.outlier_fraction = 0.01;
    sort_into_blocks(state.mixture);
  }
};

TEST(Twins, areTheViewsThatMovedToWhereTheTemplateLooksTheSame) {
  const Registered r(structure("C4", 5, 3), {so3_exp({0.4, -0.2, 0.3}), {0.1, 0.2, 0}}, 3);
  const Eigen::Vector3d middle(0.1, 0.2, 0);
  const auto turned = [&](const Pose& pose, double angle) {
    const Eigen::Matrix3d frame = so3_exp({0.4, -0.2, 0.3});
    const Eigen::Matrix3d turn = frame * so3_exp({0, 0, angle}) * frame.transpose();
    return Pose{turn, middle - turn * middle} * pose;
  };
  std::vector<Pose> after = r.state.pose;
  after[0] = turned(after[0], kPi / 2);
  after[1] = turned(after[1], kPi);
  after[2] = turned(after[2], kPi / 4);
  after[3].translation.x() += 0.5;
  EXPECT_EQ(twins(r.state.mixture, false, r.state.pose, after, {0, 1, 2, 3}), 2);
  EXPECT_EQ(twins(r.state.mixture, false, r.state.pose, after, {2}), 0);
  EXPECT_EQ(twins(r.state.mixture, false, r.state.pose, after, {}), 0);
}

Symmetry detected(const Eigen::Matrix3Xd& sites, const Pose& frame, bool planar = false) {
  const Registered r(sites, frame, 11, planar);
  const Problems problems = make_problems(r.views, 1);
  return detect_symmetry(problems.plain, r.noise, r.state);
}

Pose some_frame(std::uint64_t seed) {
  KeyedRandom random(seed, 0, 3);
  return {random.rotation(), {0.1, -0.05, 0.15}};
}

TEST(DetectSymmetry, namesTheGroupThatIsThere) {
  for (const auto& [group, sites] : std::vector<std::pair<std::string, int>>{
           {"C2", 8}, {"C3", 5}, {"C8", 2}, {"D8", 1}, {"D3", 3}, {"T", 2}, {"O", 1}, {"I", 1}}) {
    const Symmetry s = detected(structure(group, sites, 21), some_frame(5));
    EXPECT_EQ(s.group, group);
    EXPECT_GT(s.gain, -0.02) << group;
  }
}

TEST(DetectSymmetry, anAsymmetricStructureIsC1) {
  for (const std::uint64_t seed : {31u, 32u, 33u})
    EXPECT_EQ(detected(structure("none", 20, seed), some_frame(6)).group, "C1");
}

TEST(DetectSymmetry, theAxisTurnsWithTheTemplate) {
  const Eigen::Matrix3Xd sites = structure("C5", 3, 22);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Pose frame = some_frame(seed);
    const Symmetry s = detected(sites, frame);
    ASSERT_EQ(s.group, "C5");
    const Eigen::Vector3d axis = frame.rotation.col(2);
    EXPECT_LT(std::acos(std::min(1.0, std::abs(axis.dot(s.axis())))), kAxisTolerance);
    // The centre is free along the axis.
    const Eigen::Vector3d off = s.centre() - frame.translation;
    EXPECT_LT((off - axis.dot(off) * axis).norm(), 0.02);
  }
}

TEST(DetectSymmetry, inThePlaneThereAreTurnsAboutZOnly) {
  const Pose frame{so3_exp({0, 0, 0.7}), {0.1, -0.1, 0}};
  const Symmetry s = detected(structure("C6", 3, 23, true), frame, true);
  EXPECT_EQ(s.group, "C6");
  EXPECT_NEAR(s.axis().z(), 1, 1e-12);
  EXPECT_LT((s.centre() - frame.translation).norm(), 0.02);
  EXPECT_EQ(detected(structure("none", 12, 24, true), frame, true).group, "C1");
}

TEST(DetectSymmetry, aHoopAndASphereAreContinuousAndDoEnd) {
  Eigen::Matrix3Xd hoop(3, 200), ball(3, 1500);
  for (Eigen::Index k = 0; k < 200; ++k) {
    const double a = 2 * 3.14159265358979 * static_cast<double>(k) / 200;
    hoop.col(k) = Eigen::Vector3d(std::cos(a), std::sin(a), 0);
  }
  for (Eigen::Index k = 0; k < 1500; ++k) {
    const double z = 1 - (2.0 * static_cast<double>(k) + 1) / 1500, r = std::sqrt(1 - z * z),
                 a = 2.39996 * static_cast<double>(k);
    ball.col(k) = Eigen::Vector3d(r * std::cos(a), r * std::sin(a), z);
  }
  EXPECT_EQ(detected(hoop, some_frame(7)).group, "Dinf");
  EXPECT_EQ(detected(ball, some_frame(7)).group, "SO3");
}

TEST(ImposeSymmetry, movesTheTemplateIntoTheGroupsOwnFrame) {
  const RotationGroup d8 = symmetry_rotations("D8");
  Registered r(structure("D8", 1, 25), some_frame(8), 12);
  const Problems problems = make_problems(r.views, 1);
  const Symmetry s = impose_symmetry(problems.plain, r.noise, "D8", r.state);
  EXPECT_TRUE(symmetry_warning(s).empty());
  EXPECT_EQ(r.state.mixture.size(), 16);
  for (const Eigen::Matrix3d& g : d8)
    for (Eigen::Index k = 0; k < r.state.mixture.size(); ++k) {
      const Eigen::Vector3f image = g.cast<float>() * r.state.mixture.centre.col(k);
      EXPECT_LT((r.state.mixture.centre.colwise() - image).colwise().norm().minCoeff(), 1e-5f);
    }
}

TEST(ImposeSymmetry, aGroupThatTheStructureLacksGivesAWarning) {
  Registered r(structure("none", 20, 31), some_frame(8), 12);
  const Problems problems = make_problems(r.views, 1);
  const Symmetry s = impose_symmetry(problems.plain, r.noise, "C4", r.state);
  EXPECT_NE(symmetry_warning(s).find("does not look like C4"), std::string::npos);
}

TEST(RegisterFromSymmetry, countsUnitsAndRefusesSpaceGroupsInThePlane) {
  Registered r(structure("C3", 4, 26), Pose{}, 13);
  RegistrationOptions options;
  options.symmetry = "C3";
  Progress silent;
  const Registration found = register_from(r.views, r.state.pose, options, silent);
  ASSERT_TRUE(found.symmetry.has_value());
  ASSERT_EQ(found.symmetry->unit_share.size(), 3u);
  EXPECT_NEAR(std::accumulate(found.symmetry->unit_share.begin(), found.symmetry->unit_share.end(), 0.0), 1,
              1e-12);
  for (const double share : found.symmetry->unit_share) EXPECT_NEAR(share, 1.0 / 3, 0.05);
  r.views.planar = true;
  options.symmetry = "D3";
  EXPECT_THROW(register_from(r.views, r.state.pose, options, silent), smlm::Error);
}

}  // namespace
}  // namespace polar
