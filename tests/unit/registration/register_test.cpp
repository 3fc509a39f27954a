#include "polar/registration/register.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/registration/prepare.hpp"
#include "polar/simulation/simulate.hpp"
#include "scene.hpp"

namespace polar {
namespace {

struct Simulated {
  Views views;
  std::vector<Eigen::Matrix3d> structure_from_view;
};

Simulated simulated(const SimulationOptions& options) {
  const Simulation s = simulate(make_structure({}), options);
  Simulated out;
  out.views = prepare_views(smlm::group_particles(s.table));
  for (const auto& p : s.particle) out.structure_from_view.push_back(p.structure_from_view.rotation);
  return out;
}

SimulationOptions small(std::uint64_t seed) {
  SimulationOptions o;  // nuclear pores, symmetry D8
  o.seed = seed;
  o.particles = 40;
  o.blinks_mean = 6;
  o.cramer_rao = false;
  return o;
}

// Share of pairs of views whose relative rotation is right within `deg`, modulo D8.
double recall(const Registration& r, const std::vector<Eigen::Matrix3d>& truth, double deg) {
  const std::vector<Eigen::Matrix3d> group = symmetry_rotations("D8");
  int right = 0, pairs = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    for (std::size_t j = i + 1; j < truth.size(); ++j, ++pairs) {
      const Eigen::Matrix3d gi = r.view[i].template_from_view.rotation * truth[i].transpose();
      const Eigen::Matrix3d gj = r.view[j].template_from_view.rotation * truth[j].transpose();
      const Eigen::Matrix3d relative = gi.transpose() * gj;
      right += std::any_of(group.begin(), group.end(), [&](const Eigen::Matrix3d& g) {
        return geodesic_angle(relative, g) * 57.29578 < deg;
      });
    }
  return static_cast<double>(right) / pairs;
}

TEST(RegisterViews, findsPoresInRandomOrientations) {
  const Simulated s = simulated(small(3));
  Progress silent;
  const Registration r = register_views(s.views, {}, silent);
  EXPECT_GT(recall(r, s.structure_from_view, 10), 0.9);
  EXPECT_EQ(r.view.size(), 40u);
  EXPECT_NEAR(r.calibration.lateral_factor, 1, 0.35);
  int winners = 0;
  for (const auto& start : r.starts) winners += start.won;
  EXPECT_EQ(winners, 1);
}

TEST(RegisterViews, givesTheSameBitsForAnyNumberOfThreads) {
  const Simulated s = simulated(small(4));
  RegistrationOptions options;
  options.starts = {"imaged"};
  Progress silent;
  Registration one, two;
  {
    const ThreadLimit limit(1);
    one = register_views(s.views, options, silent);
  }
  {
    const ThreadLimit limit(3);
    two = register_views(s.views, options, silent);
  }
  for (std::size_t i = 0; i < one.view.size(); ++i) {
    EXPECT_EQ(one.view[i].template_from_view.rotation, two.view[i].template_from_view.rotation) << i;
    EXPECT_EQ(one.view[i].template_from_view.translation, two.view[i].template_from_view.translation) << i;
    EXPECT_EQ(one.view[i].log_likelihood, two.view[i].log_likelihood) << i;
  }
}

TEST(RegisterViews, aViewWithANumberThatIsNoneIsMarkedAndTheOthersGoOn) {
  SimulationOptions o = small(6);
  o.particles = 12;
  Simulated s = simulated(o);
  s.views.view[4].points(1, 3) = std::numeric_limits<float>::quiet_NaN();
  s.views.view[7].covariance[2][0] = std::numeric_limits<float>::infinity();
  RegistrationOptions options;
  options.starts = {"imaged"};
  Progress silent;
  const Registration r = register_views(s.views, options, silent);
  for (std::size_t i = 0; i < r.view.size(); ++i) {
    EXPECT_EQ(r.view[i].accepted, i != 4 && i != 7) << i << ": " << r.view[i].reason;
    EXPECT_TRUE(r.view[i].template_from_view.rotation.allFinite()) << i;
  }
  EXPECT_TRUE(r.fused.centre.allFinite());
}

// Keeps states in memory and, as the progress of the same run, asks to stop once `most` were kept.
class Interrupting : public Checkpoint, public Progress {
 public:
  std::optional<std::string> load(const std::string& name) override {
    const auto found = kept.find(name);
    return found == kept.end() ? std::nullopt : std::optional<std::string>(found->second);
  }
  void keep(const std::string& name, std::string bytes) override {
    kept[name] = std::move(bytes);
    names.insert(name);
    ++count;
  }
  void drop(const std::string& prefix) override {
    for (auto at = kept.begin(); at != kept.end();)
      at = at->first.compare(0, prefix.size(), prefix) == 0 ? kept.erase(at) : std::next(at);
  }
  bool cancelled() const override { return count >= most; }

  std::map<std::string, std::string> kept;
  std::set<std::string> names;
  int count = 0, most = 1 << 30;
};

void expectTheSameBitsAfterInterruptions(const Views& views, const RegistrationOptions& options,
                                         const Registration& expected, const Interrupting& whole) {
  EXPECT_THAT(whole.names, ::testing::UnorderedElementsAre("coarse", "fine"));
  for (int most = 1; most <= whole.count; most += 1 + most / 3) {
    Interrupting run;
    run.most = most;
    register_views(views, options, run, run);
    ASSERT_TRUE(run.cancelled()) << most;
    run.most = 1 << 30;
    const Registration r = register_views(views, options, run, run);
    ASSERT_EQ(r.stopped_because, expected.stopped_because) << most;
    ASSERT_EQ(r.starts.size(), expected.starts.size());
    ASSERT_EQ(r.agreement, expected.agreement);
    for (std::size_t k = 0; k < r.starts.size(); ++k)
      EXPECT_EQ(r.starts[k].held_out_log_likelihood, expected.starts[k].held_out_log_likelihood);
    EXPECT_EQ(r.fused.centre, expected.fused.centre) << most;
    for (std::size_t i = 0; i < r.view.size(); ++i) {
      EXPECT_EQ(r.view[i].template_from_view.rotation, expected.view[i].template_from_view.rotation) << most;
      EXPECT_EQ(r.view[i].template_from_view.translation, expected.view[i].template_from_view.translation)
          << most;
      EXPECT_EQ(r.view[i].covariance, expected.view[i].covariance) << most;
      EXPECT_EQ(r.view[i].margin, expected.view[i].margin) << most;
    }
  }
}

TEST(RegisterViews, continuesFromTheStatesItKeepsToTheSameBits) {
  SimulationOptions o = small(5);
  o.particles = 12;
  const Simulated s = simulated(o);
  RegistrationOptions options;
  options.starts = {"polar", "imaged"};
  options.latent.rotations = 300;
  options.latent.localisations = 100;
  Interrupting whole;
  const Registration expected = register_views(s.views, options, whole, whole);
  expectTheSameBitsAfterInterruptions(s.views, options, expected, whole);
}

TEST(RegisterViews, continuesWhereRandomStartsAgreeToTheSameBits) {
  const Scene scene(orbit_structure("none", 12, 4), 20, 1, 6, 4);
  Interrupting whole;
  const Registration expected = register_views(scene.views, {}, whole, whole);
  ASSERT_GT(expected.agreement, 0);
  expectTheSameBitsAfterInterruptions(scene.views, {}, expected, whole);
}

TEST(RegisterViews, planarDataStaysInItsPlane) {
  SimulationOptions o = small(6);
  o.planar = true;
  o.orientation = "in_plane";
  const Simulated s = simulated(o);
  Progress silent;
  const Registration r = register_views(s.views, {}, silent);
  for (const auto& v : r.view) {
    EXPECT_NEAR(v.template_from_view.rotation(2, 2), 1, 1e-9);
    EXPECT_NEAR(v.template_from_view.translation.z(), 0, 1e-9);
  }
  EXPECT_GT(recall(r, s.structure_from_view, 10), 0.9);
}

TEST(RegisterViews, aViewWithTooFewLocalisationsIsNotAcceptedAndSaysWhy) {
  Simulated s = simulated(small(7));
  s.views.view[4].points.conservativeResize(3, 2);
  s.views.view[4].covariance.resize(2);
  s.views.view[5].points.resize(3, 0);
  s.views.view[5].covariance.clear();
  RegistrationOptions options;
  options.starts = {"imaged"};
  Progress silent;
  const Registration r = register_views(s.views, options, silent);
  EXPECT_FALSE(r.view[4].accepted);
  EXPECT_FALSE(r.view[5].accepted);
  EXPECT_NE(r.view[4].reason.find("localisations"), std::string::npos);
  EXPECT_TRUE(r.view[6].accepted);
}

TEST(RegisterFrom, trueOrFoundPosesEndAtTheSameLikelihood) {
  const Simulated s = simulated(small(3));
  RegistrationOptions options;
  options.starts = {"random"};
  Progress silent;
  const Registration found = register_views(s.views, options, silent);
  std::vector<Pose> given;
  for (const auto& v : found.view) given.push_back(v.template_from_view);
  const Registration again = register_from(s.views, given, {}, silent);
  EXPECT_GT(recall(again, s.structure_from_view, 10), 0.9);
}

TEST(Violations, nameTheKeyAndTheValue) {
  RegistrationOptions o;
  o.starts = {"random", "random", "guess"};
  o.search = "slow";
  o.symmetry = "C8x";
  const auto faults = violations(o);
  ASSERT_EQ(faults.size(), 4u);
  EXPECT_NE(faults[0].find("guess"), std::string::npos);
  EXPECT_NE(faults[3].find("registration.symmetry"), std::string::npos);
  for (const char* known : {"auto", "none", "detect", "C8", "D8", "T", "O", "I"}) {
    RegistrationOptions fine;
    fine.symmetry = known;
    EXPECT_TRUE(violations(fine).empty()) << known;
  }
  for (const char* unknown : {"C0", "C1", "D1", "C361", "t", "detect8", ""}) {
    RegistrationOptions wrong;
    wrong.symmetry = unknown;
    EXPECT_EQ(violations(wrong).size(), 1u) << unknown;
  }
}

TEST(Violations, aFlipNeedsATilt) {
  RegistrationOptions o;
  o.flip = true;
  EXPECT_EQ(violations(o).size(), 1u);
  o.tilt_deg = 15;
  EXPECT_TRUE(violations(o).empty());
  o.tilt_deg = 91;
  EXPECT_EQ(violations(o).size(), 1u);
}

}  // namespace
}  // namespace polar
