#include "registration/data/evenness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "polar/core/constants.hpp"
#include "polar/registration/prepare.hpp"
#include "smlm/particle_set.hpp"

namespace polar {
namespace {

constexpr int kOnSphere = 400, kOnStrand = 600;

// A sphere of radius 1, evenly covered, and a straight strand of length 2 that leaves it along x.
Eigen::Matrix3Xf sphere_and_strand(int strand) {
  KeyedRandom random(1, 0, 0);
  Eigen::Matrix3Xf points(3, kOnSphere + strand);
  for (int j = 0; j < kOnSphere; ++j) points.col(j) = random.direction().cast<float>();
  for (int j = 0; j < strand; ++j)
    points.col(kOnSphere + j) = Eigen::Vector3f(1 + 2 * static_cast<float>(random.uniform()), 0, 0);
  return points;
}

double sum(const std::vector<double>& w, int begin, int end) {
  double total = 0;
  for (int j = begin; j < end; ++j) total += w[static_cast<std::size_t>(j)];
  return total;
}

TEST(EvenWeights, anEvenlyCoveredSurfaceIsLeftAlmostAlone) {
  const std::vector<double> w = even_weights(sphere_and_strand(0), 0.15);
  EXPECT_GT(sum(w, 0, kOnSphere) / kOnSphere, 0.8);
}

TEST(EvenWeights, aStrandCountsAsLongAsItIsNotAsItsLocalisations) {
  const std::vector<double> w = even_weights(sphere_and_strand(kOnStrand), 0.15);
  const double surface = sum(w, 0, kOnSphere), strand = sum(w, kOnSphere, kOnSphere + kOnStrand);
  // Balls of radius .15 hold 90 of the strand's 600 and 2.25 of the surface's 400 localisations.
  EXPECT_LT(strand, 0.15 * surface);
  EXPECT_GT(surface / kOnSphere, 0.8);
}

TEST(EvenWeights, areNoMatterOfPose) {
  const Eigen::Matrix3Xf points = sphere_and_strand(50);
  KeyedRandom random(2, 0, 0);
  const Eigen::Matrix3Xf moved =
      (random.rotation().cast<float>() * points).colwise() + Eigen::Vector3f(3, -2, 1);
  const std::vector<double> a = even_weights(points, 0.15), b = even_weights(moved, 0.15);
  int different = 0;  // a neighbour at the very edge of the ball may fall on either side
  for (std::size_t j = 0; j < a.size(); ++j) different += std::abs(a[j] - b[j]) > 1e-9 ? 1 : 0;
  EXPECT_LT(different, 5);
}

TEST(SamplingOrder, isAPermutationWhosePrefixFollowsTheWeights) {
  std::vector<double> weight(1000, 0.1);
  std::fill(weight.begin(), weight.begin() + 500, 1.0);
  const std::vector<std::uint32_t> order = sampling_order(weight, KeyedRandom(3, 0, 0));
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), weight.size());
  int heavy = 0;
  for (std::size_t j = 0; j < 200; ++j) heavy += order[j] < 500 ? 1 : 0;
  // One draw in eleven is light at first, one in seven or so at the end; 200 draws have a deviation of 4.6.
  EXPECT_GT(heavy, 160);
  EXPECT_LT(heavy, 195);
}

TEST(PrepareViews, aStrandMovesTheCentreLittle) {
  const Eigen::Matrix3Xf points = sphere_and_strand(kOnStrand);
  smlm::LocalisationTable table;
  table.particle_names = {"1"};
  for (Eigen::Index j = 0; j < points.cols(); ++j) {
    const Eigen::Vector3d x = 50 * points.col(j).cast<double>();
    table.position_nm.push_back({x.x(), x.y(), x.z()});
    table.covariance_nm2.push_back({25, 0, 0, 25, 0, 25});
    table.particle.push_back(0);
  }
  const Views views = prepare_views(smlm::group_particles(std::move(table)));
  // The plain geometric median lies on the strand, 50 nm and more from the centre.
  EXPECT_LT(views.normalisation.centre_nm[0].norm(), 10);
  EXPECT_NEAR(views.normalisation.scale_nm, 1.4 * 50, 7);
}

}  // namespace
}  // namespace polar
