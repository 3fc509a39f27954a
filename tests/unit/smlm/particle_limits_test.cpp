#include "smlm/particle_limits.hpp"

#include <gmock/gmock.h>

namespace smlm {
namespace {

// Particles of 1, 2, ... localisations, each spread evenly over twice its number in nm along x.
ParticleSet set_of(std::size_t particles) {
  LocalisationTable t;
  for (std::size_t p = 0; p < particles; ++p) {
    t.particle_names.push_back(std::to_string(p));
    for (std::size_t i = 0; i <= p; ++i) {
      t.position_nm.push_back({2.0 * static_cast<double>(i), 0, 0});
      t.particle.push_back(static_cast<std::int64_t>(p));
    }
  }
  return group_particles(std::move(t));
}

TEST(ParticleLimits, NameTheUnfitAndWhy) {
  const ParticleSet set = set_of(5);
  EXPECT_TRUE(unfit_particles(set, {}).empty());
  ParticleLimits limits;
  limits.localisations = {2, 4};
  const auto by_count = unfit_particles(set, limits);
  ASSERT_EQ(by_count.size(), 2u);
  EXPECT_EQ(by_count[0].reason, "left out: fewer than 2 localisations");
  EXPECT_EQ(by_count[1].particle, 4u);
  EXPECT_EQ(by_count[1].reason, "left out: more than 4 localisations");
  limits = {};
  limits.radius_nm = {0, 1.5};  // 1, 1.63, 2.24, 2.83 nm
  const auto by_extent = unfit_particles(set, limits);
  ASSERT_EQ(by_extent.size(), 3u) << "a single localisation has no extent";
  EXPECT_EQ(by_extent[0].reason, "left out: its radius is above 1.5 nm");
}

TEST(ParticleLimits, RadiusIsTheRootMeanSquare) {
  const ParticleSet set = set_of(2);
  EXPECT_DOUBLE_EQ(radius_nm(set.table, set.particles[1].rows), 1);
  EXPECT_EQ(violations(ParticleLimits{{2, 1}, {0, 1}}).size(), 1u);
}

}  // namespace
}  // namespace smlm
