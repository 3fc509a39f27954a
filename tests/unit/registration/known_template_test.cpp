#include "registration/proposals/known_template.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "polar/core/symmetry_group.hpp"
#include "scene.hpp"

namespace polar {
namespace {

KnownTemplate known(const Eigen::Matrix3Xd& sites) {
  return {sites, std::vector<double>(static_cast<std::size_t>(sites.cols()), 1.0)};
}

// A trunk and branches, as far out as the others.
Eigen::Matrix3Xd tree() {
  Eigen::Matrix3Xd out(3, 20);
  for (int k = 0; k < 10; ++k) out.col(k) << 0, 0, -0.9 + 0.12 * k;
  for (int k = 0; k < 10; ++k) {
    const double along = 0.1 + 0.08 * k;
    out.col(10 + k) << (k % 2 == 0 ? along : -0.6 * along), (k % 3 == 0 ? 0.7 : -0.2) * along,
        0.3 + 0.5 * along;
  }
  return out;
}

RegistrationOptions options(const Eigen::Matrix3Xd& sites, std::vector<std::string> starts) {
  RegistrationOptions o;
  o.starts = std::move(starts);
  o.symmetry = "none";
  o.known = known(sites);
  o.engine.proposals.most_proposals = 1;
  o.engine.verdict.draws = 1;
  return o;
}

double right(const Registration& r, const Scene& scene) {
  std::vector<Eigen::Matrix3d> found;
  for (const RegisteredView& v : r.view) found.push_back(v.template_from_view.rotation);
  return share_right(found, scene.pose, "C1", 0.25);
}

TEST(KnownTemplate, ItsDensityLiesAtItsSitesAboutTheirCentroid) {
  Eigen::Matrix3Xd sites(3, 2);
  sites << 10, 90, 0, 0, 0, 0;
  const DensityGrid d = density_of({sites, {3, 1}}, VoxelFrame(1.5, 0.05, false), 50, 0.1);
  EXPECT_NEAR(d.centroid().norm(), 0, 0.06);  // a voxel
  EXPECT_NEAR(d.at({-0.4f, 0, 0}) / d.at({1.2f, 0, 0}), 3, 0.2);
}

TEST(KnownTemplate, TheRightOneFindsTheParticlesAndSaysWhatCouldBeItsOwn) {
  const Eigen::Matrix3Xd sites = orbit_structure("C1", 10, 3);
  const Scene scene(sites, 30, 0.8, 4, 5);
  Progress silent;
  const Registration r = register_views(scene.views, options(sites, {"template"}), silent);
  ASSERT_FALSE(r.starts.empty());
  EXPECT_EQ(r.starts.front().name, "template");
  EXPECT_GT(right(r, scene), 0.9);
  EXPECT_THAT(r.warnings, ::testing::Contains(::testing::HasSubstr("could be the template's own")));
}

TEST(KnownTemplate, TheWrongOneLosesByEvidence) {
  const Eigen::Matrix3Xd sites = orbit_structure("C1", 10, 3);
  const Scene scene(sites, 30, 0.8, 4, 5);
  Progress silent;
  const Registration r = register_views(scene.views, options(tree(), {"template", "random"}), silent);
  for (const StartReport& s : r.starts) EXPECT_FALSE(s.won && s.name == "template");
  EXPECT_GT(right(r, scene), 0.9);
}

// Noise agrees with whatever it is posed on; particles agree better with what they are.
TEST(KnownTemplate, NoiseIsToldFromTheStructure) {
  const Eigen::Matrix3Xd sites = orbit_structure("C1", 10, 3);
  const Scene scene(sites, 30, 0.8, 4, 5);
  const auto likeness = [&](const Eigen::Matrix3Xd& of) {
    const RegistrationOptions o = options(of, {"template"});
    const Problems problems = make_problems(scene.views, o.engine.evidence, 1);
    return likeness_to_known(problems.plain, problems.plain.all, o);
  };
  const Likeness same = likeness(sites), other = likeness(tree());
  EXPECT_GT(same.particles, other.particles);
  EXPECT_LT(same.own_share(), 0.8) << same.particles << " " << same.noise;
  EXPECT_GT(other.own_share(), same.own_share()) << other.particles << " " << other.noise;
  EXPECT_THAT(warning_of({0.8, 0.4}), ::testing::HasSubstr("up to 50 %"));
  EXPECT_EQ((Likeness{0.4, 0.8}.own_share()), 1);
}

}  // namespace
}  // namespace polar
