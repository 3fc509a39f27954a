#include "results/label_counts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/rng.hpp"

namespace polar::results {
namespace {

constexpr double kSpacing = 10;

// Localisations on a line of `places` places, each with a label of probability `labelled`.
struct Line {
  double labelled = 0.5, sigma = 1, strays = 0;  // strays: mean number a particle
  std::size_t places = 6;
  int single = 2;  // one label in so many has one localisation, the others five

  double extent() const { return kSpacing * static_cast<double>(places); }

  std::vector<Candidate> candidates(double x) const {
    std::vector<Candidate> all;
    for (std::size_t u = 0; u < places; ++u) {
      const double z = (x - kSpacing * static_cast<double>(u)) / sigma;
      if (std::abs(z) < 6)
        all.push_back({static_cast<std::uint32_t>(u), std::exp(-0.5 * z * z) / (sigma * 2.506628)});
    }
    return all;
  }
  std::vector<ParticleCandidates> particles(std::size_t n, std::uint64_t seed) const {
    std::vector<ParticleCandidates> all(n);
    for (std::size_t p = 0; p < n; ++p) {
      KeyedRandom random(seed, p, 1);
      for (std::size_t u = 0; u < places; ++u) {
        if (random.uniform() >= labelled) continue;
        const int k = random.below(static_cast<std::uint64_t>(single)) == 0 ? 1 : 5;
        for (int i = 0; i < k; ++i)
          all[p].push_back(candidates(kSpacing * static_cast<double>(u) + sigma * random.normal()));
      }
      for (std::uint64_t i = random.poisson(strays); i > 0; --i)
        all[p].push_back(candidates((random.uniform() - 0.5 / static_cast<double>(places)) * extent()));
    }
    return all;
  }
  PlaceCounts counted(std::size_t n, std::uint64_t seed) const {
    return count_labels(particles(n, seed), places, 1 / extent(), 0.01);
  }
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

TEST(LabelCounts, PlacesFarApartAreCountedOutright) {
  const PlaceCounts c = Line{}.counted(500, 1);
  EXPECT_NEAR(mean(c.occupancy), 0.5, 0.03);
  EXPECT_LT(c.doubt, 0.01);
  EXPECT_NEAR(c.labels[1] / (c.labels[1] + c.labels[5]), 0.5, 0.03);
  double particles = 0;
  for (const double n : c.particles) particles += n;
  EXPECT_NEAR(particles, 500, 1e-6);
}

// Sites 2.5 standard deviations apart, one label in two with a single localisation: no localisation says by
// itself whose it is. Ten sets of 200 particles: their mean is the truth within four standard errors.
TEST(LabelCounts, NeighboursDoNotLendLabels) {
  for (const double labelled : {0.3, 0.6, 0.9}) {
    Line line;
    line.labelled = labelled, line.sigma = 4;
    double sum = 0, doubt = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      const PlaceCounts c = line.counted(200, seed);
      sum += mean(c.occupancy) / 10, doubt += c.doubt / 10;
    }
    EXPECT_NEAR(sum, labelled, 4 * std::sqrt(labelled * (1 - labelled) / (10 * 200 * 6)) * 2) << labelled;
    EXPECT_GT(doubt, 0.01) << labelled;
  }
}

TEST(LabelCounts, StraysAreBackground) {
  Line line;
  line.strays = 2, line.sigma = 0.5, line.single = 20;
  const PlaceCounts c = line.counted(300, 3);
  EXPECT_NEAR(mean(c.occupancy), 0.5, 0.04);
  const double localisations = 6 * 0.5 * (0.05 * 1 + 0.95 * 5) + 2;
  EXPECT_NEAR(c.background_share, 2 / localisations, 0.02);
}

TEST(LabelCounts, NothingIsNothing) {
  EXPECT_FALSE(count_labels({}, 4, 1, 0.1).any());
  EXPECT_FALSE(count_labels({{{}, {}}}, 4, 1, 0.1).any());
}

}  // namespace
}  // namespace polar::results
