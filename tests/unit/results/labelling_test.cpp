#include "polar/results/labelling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/rng.hpp"
#include "polar/results/results.hpp"
#include "polar/results/sites.hpp"
#include "polar/simulation/simulate.hpp"
#include "support/fake_results.hpp"

namespace polar {
namespace {

std::vector<int> counts(double efficiency, int sites, int particles, int fewest, std::uint64_t trial) {
  std::vector<int> all;
  KeyedRandom random(11, trial, 1);
  while (static_cast<int>(all.size()) < particles) {
    int n = 0;
    for (int k = 0; k < sites; ++k) n += random.uniform() < efficiency ? 1 : 0;
    if (n >= fewest) all.push_back(n);
  }
  return all;
}

// Of 200 simulated sets at each efficiency the interval holds the truth in 95 %: at least 182, four standard
// errors below.
TEST(Labelling, IntervalsHoldTheTruth) {
  for (const double truth : {0.3, 0.5, 0.7, 0.9})
    for (const int fewest : {1, 3}) {
      int held = 0;
      for (std::uint64_t trial = 0; trial < 200; ++trial) {
        const Labelling l = labelling_efficiency(counts(truth, 8, 60, fewest, trial), 8, 1);
        held += l.low <= truth && truth <= l.high ? 1 : 0;
      }
      EXPECT_GE(held, 182) << truth << " of particles with " << fewest << " sites or more";
      EXPECT_LE(held, 200);
    }
}

TEST(Labelling, SitesOfSeveralLabels) {
  std::vector<int> occupied;
  KeyedRandom random(12, 0, 1);
  for (int i = 0; i < 2000; ++i) {
    int n = 0;
    for (int k = 0; k < 16; ++k) n += random.uniform() < 0.4 || random.uniform() < 0.4 ? 1 : 0;
    occupied.push_back(n);
  }
  const Labelling l = labelling_efficiency(occupied, 16, 2);
  EXPECT_NEAR(l.efficiency, 0.4, 0.02);
  EXPECT_LT(l.low, l.efficiency);
  EXPECT_GT(l.high, l.efficiency);
  EXPECT_NEAR(l.dispersion, 1, 0.15);
}

TEST(Labelling, EveryAndOneSite) {
  EXPECT_GT(labelling_efficiency(std::vector<int>(20, 6), 6, 1).efficiency, 0.999);
  EXPECT_GT(labelling_efficiency(std::vector<int>(20, 6), 6, 1).low, 0.95);
  EXPECT_LT(labelling_efficiency(std::vector<int>(20, 1), 6, 1).efficiency, 0.01);
}

// Five of 24 particles lack one of 17 sites, or two: nothing is missing, and the efficiency is that share.
TEST(Labelling, NearlyEverySite) {
  std::vector<int> occupied(19, 17);
  occupied.insert(occupied.end(), {16, 16, 16, 16, 15});
  const Labelling l = labelling_efficiency(occupied, 17, 1);
  EXPECT_EQ(l.particles, 24u);
  EXPECT_NEAR(l.efficiency, 1 - 6.0 / (24 * 17), 0.01);
  EXPECT_GT(l.low, 0.95);
}

// Particles that are labelled together, all or nothing, tell less than independent ones.
TEST(Labelling, DispersionWidensTheInterval) {
  std::vector<int> together;
  for (int i = 0; i < 30; ++i) together.push_back(i % 2 == 0 ? 2 : 6);
  const Labelling wide = labelling_efficiency(together, 8, 1);
  const Labelling narrow = labelling_efficiency(std::vector<int>(30, 4), 8, 1);
  EXPECT_GT(wide.dispersion, 1.5);
  EXPECT_GT(wide.high - wide.low, 1.2 * (narrow.high - narrow.low));
}

class Sites : public ::testing::Test {
 protected:
  static smlm::LocalisationTable aligned_rings(double efficiency, int particles, std::uint64_t seed) {
    StructureOptions ring;
    ring.kind = "ring";
    SimulationOptions options;
    options.particles = particles;
    options.seed = seed;
    options.labelling_efficiency = efficiency;
    options.sigma_xy_nm = {3, 5};
    options.sigma_z_factor = {1, 2};
    options.cramer_rao = false;
    const Structure structure = make_structure(ring);
    return superparticle(support::perfect_results(simulate(structure, options), structure));
  }
};

TEST_F(Sites, AreFoundWhereTheyAre) {
  const DiscreteSites found = find_sites(aligned_rings(0.7, 100, 1), {});
  ASSERT_EQ(found.site.size(), 8u) << found.reason;
  for (const Site& s : found.site) {
    EXPECT_NEAR(s.centre_nm.head<2>().norm(), 50, 5 * s.centre_std_nm);
    EXPECT_NEAR(s.centre_nm.z(), 0, 5 * s.centre_std_nm);
    EXPECT_NEAR(s.width_nm, 2, 1) << "the label's size";
    EXPECT_NEAR(s.occupancy, 0.7, 0.2);
    EXPECT_NEAR(s.share, 0.125, 0.05);
  }
  EXPECT_TRUE(hot_spots(found).empty());
  EXPECT_EQ(format_sites_csv(found).substr(0, 10), "x_nm,y_nm,");
}

TEST_F(Sites, LabellingOfSimulatedParticlesIsTheirs) {
  for (const double truth : {0.3, 0.5, 0.7, 0.9}) {
    int held = 0;
    constexpr int kTrials = 3;
    for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
      const DiscreteSites found = find_sites(aligned_rings(truth, 60, seed), {});
      ASSERT_EQ(found.site.size(), 8u) << truth << " " << seed << " " << found.reason;
      const Labelling l = labelling_efficiency(found.occupied, 8, 1);
      held += l.low <= truth && truth <= l.high ? 1 : 0;
    }
    EXPECT_GE(held, 2) << truth;
  }
}

TEST_F(Sites, ACloudHasNone) {
  smlm::LocalisationTable t;
  KeyedRandom random(13, 0, 1);
  t.particle_names = {"a", "b"};
  for (int i = 0; i < 2000; ++i) {
    t.position_nm.push_back({40 * random.normal(), 40 * random.normal(), 40 * random.normal()});
    t.covariance_nm2.push_back({25, 0, 0, 25, 0, 25});
    t.particle.push_back(i % 2);
  }
  const DiscreteSites found = find_sites(t, {});
  EXPECT_TRUE(found.site.empty());
  EXPECT_FALSE(found.reason.empty());
  EXPECT_FALSE(find_sites(smlm::LocalisationTable{}, {}).reason.empty());
}

TEST_F(Sites, AHotSpotIsNamed) {
  DiscreteSites found;
  found.occupied.assign(100, 3);
  for (int k = 0; k < 6; ++k) {
    found.site.emplace_back();
    found.site.back().occupancy = k == 2 ? 0.95 : 0.5;
  }
  EXPECT_EQ(hot_spots(found), std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace polar
