#include "registration/data/bursts.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "polar/core/covariance3.hpp"
#include "registration/data/problem.hpp"
#include "scene.hpp"

namespace polar {
namespace {

View points(const std::vector<Eigen::Vector3f>& at, float sigma) {
  View view;
  view.points.resize(3, static_cast<Eigen::Index>(at.size()));
  for (std::size_t j = 0; j < at.size(); ++j) view.points.col(static_cast<Eigen::Index>(j)) = at[j];
  view.covariance.assign(at.size(), isotropic_covariance(sigma * sigma));
  return view;
}

std::vector<std::uint32_t> in_order(std::size_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

TEST(Bursts, whatLiesWithinTheUncertaintyIsOneAndTheRestAreOthers) {
  const View v = points({{0, 0, 0}, {0.01f, 0, 0}, {1, 0, 0}, {0, 0.012f, 0}, {1, 0.01f, 0}}, 0.01f);
  EXPECT_EQ(bursts(v, in_order(5), 3, false), (std::vector<int>{0, 0, 1, 0, 1}));
}

TEST(Bursts, theDistanceIsMeasuredByBothUncertainties) {
  // 0.03 apart, sigma 0.01 each: 0.03 / (sqrt(2) 0.01) = 2.12.
  const View v = points({{0, 0, 0}, {0.03f, 0, 0}}, 0.01f);
  EXPECT_EQ(bursts(v, in_order(2), 2.2, false)[1], 0);
  EXPECT_EQ(bursts(v, in_order(2), 2.0, false)[1], 1);
}

TEST(Bursts, inThePlaneZSaysNothing) {
  View v = points({{0, 0, 0}, {0, 0, 0}}, 0.01f);
  v.covariance[0][5] = v.covariance[1][5] = 0;  // no uncertainty along z
  EXPECT_EQ(bursts(v, in_order(2), 2, true), (std::vector<int>{0, 0}));
}

TEST(MakeProblems, noBurstIsFittedAndHeldOut) {
  const Scene scene(orbit_structure("none", 12, 4), 10, 0.7, 8, 5);
  EvidenceOptions options;
  const Problems p = make_problems(scene.views, options, 1);
  std::size_t judged = 0;
  for (std::size_t i = 0; i < scene.views.view.size(); ++i) {
    const std::vector<int> burst =
        bursts(scene.views.view[i], p.plain.shuffled[i], options.burst_distance, false);
    std::set<int> fitted;
    for (const std::uint32_t j : p.plain.fitted[i]) fitted.insert(burst[j]);
    for (const std::uint32_t j : p.plain.held_out[i]) EXPECT_EQ(fitted.count(burst[j]), 0u) << i;
    for (const std::uint32_t j : p.thinned.fitted[i])
      for (const std::uint32_t k : p.plain.held_out[i]) EXPECT_NE(burst[j], burst[k]) << i;
    judged += p.plain.held_out[i].size();
  }
  EXPECT_GT(judged, scene.views.view.size());
}

}  // namespace
}  // namespace polar
