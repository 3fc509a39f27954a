#include "registration/fullness.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "polar/core/rng.hpp"

namespace polar {
namespace {

constexpr float kReach = 0.15f;

// So many localisations at each of some sites a unit apart.
Eigen::Matrix3Xf sites(const std::vector<int>& localisations) {
  Eigen::Matrix3Xf points(3, std::accumulate(localisations.begin(), localisations.end(), 0));
  Eigen::Index j = 0;
  for (std::size_t s = 0; s < localisations.size(); ++s)
    for (int k = 0; k < localisations[s]; ++k) points.col(j++) = Eigen::Vector3f(static_cast<float>(s), 0, 0);
  return points;
}

std::vector<std::uint32_t> all_of(const Eigen::Matrix3Xf& points) {
  std::vector<std::uint32_t> which(static_cast<std::size_t>(points.cols()));
  std::iota(which.begin(), which.end(), 0u);
  return which;
}

double spots(const Eigen::Matrix3Xf& points) { return occupied_spots(points, all_of(points), kReach); }

TEST(OccupiedSpots, areTheSitesWhereAllAreAlike) {
  EXPECT_DOUBLE_EQ(spots(sites({10, 10, 10, 10})), 4);
  EXPECT_DOUBLE_EQ(spots(sites({3, 3, 3, 3})), 4);
  EXPECT_DOUBLE_EQ(spots(sites({1})), 1);
  EXPECT_EQ(spots(sites({})), 0);
}

TEST(OccupiedSpots, aBrightSiteDoesNotStandForManyDimOnes) {
  EXPECT_LT(spots(sites({60})), spots(sites({5, 5})));
  EXPECT_LT(spots(sites({60, 5, 5})), spots(sites({10, 10, 10, 10})));
}

TEST(OccupiedSpots, strayLocalisationsAreNoSites) {
  EXPECT_LT(spots(sites({10, 10, 10, 10, 1, 1, 1})), 5.5);  // of seven that hold something
}

TEST(OccupiedSpots, areNoMatterOfPose) {
  KeyedRandom random(3, 0, 0);
  const Eigen::Matrix3Xf points = sites({10, 4, 7, 1});
  const Eigen::Matrix3Xf moved =
      (random.rotation().cast<float>() * points).colwise() + Eigen::Vector3f(3, -2, 1);
  EXPECT_DOUBLE_EQ(spots(points), spots(moved));
}

TEST(FullestViews, comeFirstAndAreThoseWithTheMostSitesNotTheMostLocalisations) {
  Views views;
  for (const std::vector<int>& s :
       {std::vector<int>{90, 9}, {12, 12, 12, 12, 12}, {12, 12, 12}, {200}, {12, 12, 12, 12}}) {
    const Eigen::Matrix3Xf points = sites(s);
    views.view.push_back({points, std::vector<Symmetric3>(static_cast<std::size_t>(points.cols()),
                                                          {1e-4f, 0, 1e-4f, 0, 0, 1e-4f})});
  }
  const Problems problems = make_problems(views, 1);
  Subsets all;
  for (const View& v : views.view) all.push_back(all_of(v.points));
  EXPECT_EQ(fullest_views(problems.plain, all, 3), (std::vector<int>{1, 4, 2}));
  EXPECT_EQ(fullest_views(problems.plain, all, 9).size(), 5u);
}

}  // namespace
}  // namespace polar
