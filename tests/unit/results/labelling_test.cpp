#include "polar/results/labelling.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/results/results.hpp"
#include "polar/results/sites.hpp"
#include "polar/results/units.hpp"
#include "polar/simulation/simulate.hpp"
#include "support/fake_results.hpp"

namespace polar {
namespace {

// Counts that nobody doubts.
PlaceCounts certain(const std::vector<int>& occupied, int sites) {
  PlaceCounts c;
  c.occupancy.assign(static_cast<std::size_t>(sites), 0.5);
  c.particles.assign(static_cast<std::size_t>(sites) + 1, 0.0);
  for (const int n : occupied) c.particles[static_cast<std::size_t>(n)] += 1;
  return c;
}

PlaceCounts counts(double efficiency, int sites, int particles, int fewest, std::uint64_t trial) {
  std::vector<int> all;
  KeyedRandom random(11, trial, 1);
  while (static_cast<int>(all.size()) < particles) {
    int n = 0;
    for (int k = 0; k < sites; ++k) n += random.uniform() < efficiency ? 1 : 0;
    if (n >= fewest) all.push_back(n);
  }
  return certain(all, sites);
}

// Of 200 simulated sets at each efficiency the interval holds the truth in 95 %: at least 182, four standard
// errors below.
TEST(Labelling, IntervalsHoldTheTruth) {
  for (const double truth : {0.3, 0.5, 0.7, 0.9})
    for (const int fewest : {1, 3}) {
      int held = 0;
      for (std::uint64_t trial = 0; trial < 200; ++trial) {
        const Labelling l = labelling_efficiency(counts(truth, 8, 60, fewest, trial), 1);
        held += l.low <= truth && truth <= l.high ? 1 : 0;
      }
      EXPECT_GE(held, 182) << truth << " of particles with " << fewest << " sites or more";
      EXPECT_LE(held, 200);
    }
}

// Where a third of the variance is doubt, the interval is as wide as that of a third fewer particles.
TEST(Labelling, DoubtWidensTheInterval) {
  PlaceCounts c = counts(0.5, 8, 400, 1, 1);
  const Labelling sure = labelling_efficiency(c, 1);
  c.doubt = 8 * 0.25 / 3;
  const Labelling doubtful = labelling_efficiency(c, 1);
  EXPECT_NEAR(doubtful.information, 2.0 / 3, 0.02);
  EXPECT_NEAR((doubtful.high - doubtful.low) / (sure.high - sure.low), std::sqrt(1.5), 0.05);
}

TEST(Labelling, SitesOfSeveralLabels) {
  std::vector<int> occupied;
  KeyedRandom random(12, 0, 1);
  for (int i = 0; i < 2000; ++i) {
    int n = 0;
    for (int k = 0; k < 16; ++k) n += random.uniform() < 0.4 || random.uniform() < 0.4 ? 1 : 0;
    occupied.push_back(n);
  }
  const Labelling l = labelling_efficiency(certain(occupied, 16), 2);
  EXPECT_NEAR(l.efficiency, 0.4, 0.02);
  EXPECT_LT(l.low, l.efficiency);
  EXPECT_GT(l.high, l.efficiency);
  EXPECT_NEAR(l.dispersion, 1, 0.15);
}

TEST(Labelling, EveryAndOneSite) {
  EXPECT_GT(labelling_efficiency(certain(std::vector<int>(20, 6), 6), 1).efficiency, 0.999);
  EXPECT_GT(labelling_efficiency(certain(std::vector<int>(20, 6), 6), 1).low, 0.95);
  EXPECT_LT(labelling_efficiency(certain(std::vector<int>(20, 1), 6), 1).efficiency, 0.01);
}

// Five of 24 particles lack one of 17 sites, or two: nothing is missing, and the efficiency is that share.
TEST(Labelling, NearlyEverySite) {
  std::vector<int> occupied(19, 17);
  occupied.insert(occupied.end(), {16, 16, 16, 16, 15});
  const Labelling l = labelling_efficiency(certain(occupied, 17), 1);
  EXPECT_EQ(l.particles, 24u);
  EXPECT_NEAR(l.efficiency, 1 - 6.0 / (24 * 17), 0.01);
  EXPECT_GT(l.low, 0.95);
}

// Particles that are labelled together, all or nothing, tell less than independent ones.
TEST(Labelling, DispersionWidensTheInterval) {
  std::vector<int> together;
  for (int i = 0; i < 30; ++i) together.push_back(i % 2 == 0 ? 2 : 6);
  const Labelling wide = labelling_efficiency(certain(together, 8), 1);
  const Labelling narrow = labelling_efficiency(certain(std::vector<int>(30, 4), 8), 1);
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
      const Labelling l = labelling_efficiency(found.counts, 1);
      held += l.low <= truth && truth <= l.high ? 1 : 0;
    }
    EXPECT_GE(held, 2) << truth;
  }
}

// A stray on a place without a label is no label: the density of strays near the places is found from those
// that lie off them. Twelve sets at 80 %, a tenth of the localisations strays: the mean is the truth within
// three standard errors.
TEST_F(Sites, StraysLabelNothing) {
  double sum = 0, strays = 0;
  constexpr int kTrials = 12;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    SimulationOptions options;
    options.particles = 60;
    options.seed = seed;
    options.labelling_efficiency = 0.8;
    options.sigma_xy_nm = {3, 6};
    options.outlier_fraction = 0.1;
    options.cramer_rao = false;
    const Structure pore = make_structure({});
    const DiscreteSites found =
        find_sites(superparticle(support::perfect_results(simulate(pore, options), pore)), {});
    ASSERT_EQ(found.site.size(), 16u) << seed << " " << found.reason;
    sum += labelling_efficiency(found.counts, 2).efficiency / kTrials;
    strays += found.counts.background_share / kTrials;
  }
  EXPECT_NEAR(sum, 0.8, 3 * 0.018 / std::sqrt(kTrials));
  EXPECT_NEAR(strays, 0.1, 0.03);
}

class Units : public ::testing::Test {
 protected:
  // Corners of a pore with two labels 12 nm apart, neighbours 40 nm, at a lateral uncertainty of `sigma_nm`.
  static std::optional<Labelling> labelling(double efficiency, double sigma_nm, std::uint64_t seed) {
    SimulationOptions options;
    options.particles = 60;
    options.seed = seed;
    options.labelling_efficiency = efficiency;
    options.sigma_xy_nm = {sigma_nm - 1, sigma_nm + 1};
    options.sigma_z_factor = {1, 2};
    options.cramer_rao = false;
    const Structure pore = make_structure({});
    const Results r = support::perfect_results(simulate(pore, options), pore);
    const smlm::LocalisationTable aligned = superparticle(r);
    TemplateSites fused;
    fused.centre_nm = pore.site_nm;
    fused.weight =
        Eigen::VectorXd::Constant(pore.site_nm.cols(), 1.0 / static_cast<double>(pore.site_nm.cols()));
    fused.width_nm = options.label_size_nm;
    const UnitOccupancy found =
        occupied_units(aligned, fused, pore.site_nm(Eigen::all, corners(pore)), 1e-7, 1e-3);
    EXPECT_EQ(found.counts.occupancy.size(), 16u) << found.reason;
    if (!found.counts.any()) return std::nullopt;
    return labelling_efficiency(found.counts, 2);
  }
  // One site of each: no two nearer than 20 nm.
  static std::vector<Eigen::Index> corners(const Structure& pore) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 0; k < pore.site_nm.cols(); ++k)
      if (std::none_of(kept.begin(), kept.end(), [&](Eigen::Index other) {
            return (pore.site_nm.col(k) - pore.site_nm.col(other)).norm() < 20;
          }))
        kept.push_back(k);
    return kept;
  }
};

// Where a localisation often lies nearer to a neighbour than to its own unit: of 64 simulated sets the
// interval holds the truth in 95 %: 55 is three standard errors below.
TEST_F(Units, LabellingOfSimulatedParticlesIsTheirs) {
  constexpr int kTrials = 16;
  int held = 0;
  for (const double truth : {0.3, 0.5, 0.7, 0.9}) {
    double mean = 0;
    for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
      const std::optional<Labelling> l = labelling(truth, 9, seed);
      ASSERT_TRUE(l);
      held += l->low <= truth && truth <= l->high ? 1 : 0;
      mean += l->efficiency / kTrials;
    }
    EXPECT_NEAR(mean, truth, 0.015);
  }
  RecordProperty("held", held);
  EXPECT_GE(held, 55);
}

TEST_F(Units, ThatRunIntoOneAnotherAreNotCounted) {
  smlm::LocalisationTable t;
  t.particle_names = {"a"};
  t.position_nm.push_back({0, 0, 0});
  t.covariance_nm2.push_back({100, 0, 0, 100, 0, 100});
  t.particle.push_back(0);
  TemplateSites fused;
  fused.centre_nm = Eigen::Matrix3Xd::Zero(3, 2);
  fused.centre_nm(0, 1) = 20;
  fused.weight = Eigen::Vector2d(0.5, 0.5);
  EXPECT_THAT(occupied_units(t, fused, fused.centre_nm, 1e-9, 1e-3).reason,
              ::testing::HasSubstr("not far enough apart"));
  EXPECT_THAT(occupied_units(t, fused, Eigen::Matrix3Xd(3, 0), 1e-9, 1e-3).reason,
              ::testing::HasSubstr("no symmetric units"));
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

DiscreteSites ring_of(std::size_t sites, double occupancy) {
  DiscreteSites found;
  found.counts.particles = std::vector<double>(sites + 1, 100.0 / static_cast<double>(sites + 1));
  for (std::size_t k = 0; k < sites; ++k) {
    const double azimuth = kTwoPi * static_cast<double>(k) / static_cast<double>(sites);
    found.site.emplace_back();
    found.site.back().centre_nm = {50 * std::cos(azimuth), 50 * std::sin(azimuth), 0};
    found.site.back().occupancy = occupancy;
    found.orbit.push_back(k);
  }
  return found;
}

TEST_F(Sites, AHotSpotIsNamed) {
  DiscreteSites found = ring_of(6, 0.5);
  found.site[2].occupancy = 0.95;
  EXPECT_EQ(hot_spots(found), std::vector<std::size_t>{2});
}

// Labels that gather at one image of a unit are a convention of the poses; a place of its own that every
// particle shows is not.
TEST_F(Sites, UnderAGroupOnlyPlacesOfTheirOwnAreHot) {
  DiscreteSites found = ring_of(6, 0.5);
  found.site[2].occupancy = 0.95;
  const Pose canonical{Eigen::Matrix3d::Identity(), {0, 0, 1}};
  set_orbits(found, symmetry_rotations("C6"), canonical);
  EXPECT_EQ(found.orbit, std::vector<std::size_t>(6, 0));
  EXPECT_TRUE(hot_spots(found).empty());
  found.site.emplace_back();
  found.site.back().occupancy = 0.95;
  found.orbit.push_back(6);
  set_orbits(found, symmetry_rotations("C6"), canonical);
  EXPECT_EQ(found.orbit.back(), 6u);
  EXPECT_EQ(hot_spots(found), std::vector<std::size_t>{6});
}

}  // namespace
}  // namespace polar
