#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/flames/local_minima.hpp"
#include "polar/flames/neighbour_graph.hpp"
#include "polar/flames/rotation_grid.hpp"
#include "polar/flames/search_grid.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

double angle(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return geodesic_angle(a.cast<double>().toRotationMatrix(), b.cast<double>().toRotationMatrix());
}

TEST(RotationGrid, coversTheGroupEvenly) {
  const auto grid = super_fibonacci(2304);
  KeyedRandom random(1, 0, 0);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Quaternionf q(Eigen::Quaterniond(random.rotation()).cast<float>());
    double nearest = 10;
    for (const auto& g : grid) nearest = std::min(nearest, angle(q, g));
    worst = std::max(worst, nearest);
  }
  // 2,304 balls of this radius hold the group's volume 3.1 times over.
  EXPECT_LT(worst * 57.29578, 21);
}

TEST(NeighbourGraph, agreesWithBruteForce) {
  const auto grid = super_fibonacci(300);
  const NeighbourGraph graph = neighbour_graph(grid, 9);
  ASSERT_EQ(graph.size(), grid.size());
  for (const std::size_t i : {std::size_t{0}, std::size_t{17}, std::size_t{299}}) {
    std::vector<double> distance;
    for (std::size_t j = 0; j < grid.size(); ++j)
      if (j != i) distance.push_back(angle(grid[i], grid[j]));
    std::sort(distance.begin(), distance.end());
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(angle(grid[i], grid[static_cast<std::size_t>(graph.of(i)[k])]),
                  distance[static_cast<std::size_t>(k)], 1e-3);
  }
}

TEST(NeighbourGraph, cacheIsReadBackAndDamageIsNoticed) {
  const support::TemporaryDirectory directory;
  const auto grid = super_fibonacci(200);
  const NeighbourGraph first = cached_neighbour_graph(grid, 6, directory.path());
  const auto file = std::filesystem::directory_iterator(directory.path())->path();
  EXPECT_EQ(cached_neighbour_graph(grid, 6, directory.path()).neighbour, first.neighbour);
  {
    std::fstream damage(file, std::ios::in | std::ios::out | std::ios::binary);
    damage.seekp(100);
    damage.put('\x7f');
  }
  EXPECT_EQ(cached_neighbour_graph(grid, 6, directory.path()).neighbour, first.neighbour);
}

TEST(LocalMinima, findsTheWellsOfAKnownLandscape) {
  const auto grid = super_fibonacci(2304);
  const NeighbourGraph graph = neighbour_graph(grid, 12);
  KeyedRandom random(4, 0, 0);
  std::vector<Eigen::Matrix3d> well;
  while (well.size() < 4) {
    const Eigen::Matrix3d r = random.rotation();
    if (std::all_of(well.begin(), well.end(), [&](const auto& w) { return geodesic_angle(w, r) > 1.2; }))
      well.push_back(r);
  }
  std::vector<float> cost;
  for (const auto& g : grid) {
    double c = 0;
    for (std::size_t k = 0; k < well.size(); ++k) {
      const double a = geodesic_angle(g.cast<double>().toRotationMatrix(), well[k]);
      c -= (1.0 - 0.1 * static_cast<double>(k)) * std::exp(-a * a / 0.08);
    }
    cost.push_back(static_cast<float>(c));
  }
  const std::vector<int> found = local_minima(cost, graph, 4);
  ASSERT_EQ(found.size(), 4u);
  // The grid samples a well's bottom more or less well, so the order of two may change; none may be missed.
  for (const Eigen::Matrix3d& w : well) {
    double nearest = 10;
    for (const int f : found)
      nearest = std::min(
          nearest, geodesic_angle(grid[static_cast<std::size_t>(f)].cast<double>().toRotationMatrix(), w));
    EXPECT_LT(nearest, 0.37);
  }
}

TEST(LocalMinima, ignoresNanAndBreaksTiesOnce) {
  const NeighbourGraph pair{1, {1, 0}};
  EXPECT_EQ(local_minima({NAN, 1}, pair, 5), (std::vector<int>{1}));
  EXPECT_EQ(local_minima({2, 2}, pair, 5), (std::vector<int>{0}));
}

TEST(SearchGrid, OfANarrowPriorAndALargeGroupSomeRotationsAreLeft) {
  const PosePrior prior{1e-4, false};
  const SearchGrid grid = search_grid(2304, false, symmetry_rotations("D12"), prior);
  EXPECT_GE(grid.rotation.size(), 24u);
  EXPECT_LE(grid.rotation.size(), 60u);
}

TEST(SearchGrid, OutsideAPriorThereIsNothing) {
  const PosePrior prior{0.2, true};
  const SearchGrid whole = search_grid(2304, false), upright = search_grid(2304, false, {}, prior);
  const auto allowed = std::count_if(whole.rotation.begin(), whole.rotation.end(),
                                     [&](const Eigen::Matrix3f& r) { return prior.allows(r); });
  EXPECT_EQ(upright.rotation.size(), static_cast<std::size_t>(allowed));  // as dense
  EXPECT_NEAR(static_cast<double>(allowed) / 2304, prior.share(), 0.02);
  for (std::uint64_t round = 0; round < 5; ++round) {
    const Eigen::Matrix3f turn = grid_turn(false, KeyedRandom(1, round, 1), prior);
    EXPECT_GT((turn - Eigen::Matrix3f::Identity()).norm(), 1e-3f);
    for (const Eigen::Matrix3f& r : upright.rotation) {
      const Eigen::Matrix3f turned = r * turn;
      EXPECT_NEAR(turned(2, 2), r(2, 2), 1e-5f);
    }
  }
}

}  // namespace
}  // namespace polar
