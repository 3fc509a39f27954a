#include "results/occupied_sites.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace polar::results {
namespace {

using ::testing::ElementsAre;

// Three sites 10 apart on a line, localisations of a given width.
Eigen::MatrixXd densities(const std::vector<double>& x, double sigma) {
  Eigen::MatrixXd d(static_cast<Eigen::Index>(x.size()), 3);
  for (Eigen::Index i = 0; i < d.rows(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double z = (x[static_cast<std::size_t>(i)] - 10 * double(k)) / sigma;
      d(i, k) = std::exp(-0.5 * z * z) / (sigma * 2.5066);
    }
  return d;
}

TEST(OccupiedSites, ASingleLocalisationIsALabel) {
  EXPECT_THAT(occupied_sites(densities({0.3, -0.2, 0.5, 19.6}, 1), 1e-4), ElementsAre(0, 2));
}

TEST(OccupiedSites, WhatLiesBetweenBelongsToTheSiteThatIsThere) {
  EXPECT_THAT(occupied_sites(densities({-2, 1, 4, 5.2, -3, 0, 2}, 4), 1e-4), ElementsAre(0));
}

TEST(OccupiedSites, StrayOnesAreBackground) {
  EXPECT_THAT(occupied_sites(densities({0, 0.1, -0.1, 35}, 1), 1e-4), ElementsAre(0));
}

}  // namespace
}  // namespace polar::results
