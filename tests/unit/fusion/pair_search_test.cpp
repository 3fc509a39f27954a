#include "polar/fusion/pair_search.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "fixture.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"
#include "polar/fusion/seen_region.hpp"

namespace polar {
namespace {

// Points of a ball of radius 1 on one side of a plane through its centre.
Eigen::Matrix3Xf half_ball(int n, const Eigen::Vector3d& side) {
  KeyedRandom random(5, 0, 4);
  Eigen::Matrix3Xf points(3, n);
  for (int j = 0; j < n; ++j) {
    Eigen::Vector3d x = random.direction() * std::cbrt(random.uniform());
    if (x.dot(side) < 0) x = -x;
    points.col(j) = x.cast<float>();
  }
  return points;
}

TEST(SeenRegion, isTheHullOfWhatWasSeenAndTurnsWithIt) {
  const Eigen::Vector3d side = Eigen::Vector3d(1, -2, 0.5).normalized();
  const Eigen::Matrix3d turn = so3_exp({0.4, -1.1, 0.7});
  const SeenRegion region(half_ball(2000, side)), turned(half_ball(2000, turn * side));
  EXPECT_TRUE(region.contains((0.4 * side).cast<float>()));
  EXPECT_FALSE(region.contains((-0.2 * side).cast<float>()));
  EXPECT_FALSE(region.contains((1.1 * side).cast<float>()));
  EXPECT_TRUE(turned.contains((0.4 * (turn * side)).cast<float>()));
  EXPECT_FALSE(turned.contains((-0.2 * (turn * side)).cast<float>()));
}

TEST(SeenRegion, holdsThePlaneOfPlanarPoints) {
  Eigen::Matrix3Xf points = half_ball(2000, Eigen::Vector3d::UnitX());
  points.row(2).setZero();
  const SeenRegion region(points);
  EXPECT_TRUE(region.contains({0.3f, 0, 0}));
  EXPECT_FALSE(region.contains({-0.3f, 0, 0}));
}

TEST(SeenRegion, ofNothingIsEmpty) { EXPECT_FALSE(SeenRegion().contains(Eigen::Vector3f::Zero())); }

// A view of `mixture` that keeps what lies on one side of a plane through the template's centre, about its
// own centre; returns template_from_view.
Pose add_half_view(const Mixture& mixture, const Eigen::Vector3d& side, std::uint64_t seed, Views& views) {
  Pose pose = fixture::random_pose(seed);
  const View whole = fixture::draw_view(mixture, pose, 1600, 0.02f, 0.02f, seed);
  View half;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index j = 0; j < whole.points.cols(); ++j)
    if ((pose * whole.points.col(j).cast<double>()).dot(side) > 0) kept.push_back(j);
  half.points.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    half.points.col(static_cast<Eigen::Index>(k)) = whole.points.col(kept[k]);
    half.covariance.push_back(whole.covariance[static_cast<std::size_t>(kept[k])]);
  }
  const Eigen::Vector3f centre = half.points.rowwise().mean();
  half.points.colwise() -= centre;
  pose.translation += pose.rotation * centre.cast<double>();
  views.view.push_back(half);
  return pose;
}

TEST(PairSearch, alignsHalvesThatOverlapInPart) {
  const Mixture mixture = fixture::random_mixture(60, 11);
  Views views;
  const Pose first = add_half_view(mixture, Eigen::Vector3d::UnitX(), 21, views);
  const Pose second = add_half_view(mixture, Eigen::Vector3d(0.6, 0.8, 0), 22, views);
  Subsets all(2);
  for (std::size_t i = 0; i < 2; ++i)
    all[i] = random_order(views.view[i].covariance.size(), KeyedRandom(3, i, 1));
  const std::vector<Eigen::Vector3f> axes(2, Eigen::Vector3f::UnitZ());
  const PairSearch pairs(views, axes, all, {0, 1});
  const Match match = pairs.matches(0, {1}, Eigen::Matrix3f::Identity()).front();
  const Pose truth = first.inverse() * second;
  constexpr double kRight = 3 * kRadiansPerDegree;  // sites are 0.02 wide, a few dozen overlap
  EXPECT_LT(geodesic_angle(match.first_from_second.rotation, truth.rotation), kRight);
  EXPECT_LT((match.first_from_second.translation - truth.translation).norm(), 0.05);
  const Pose wrong{so3_exp({0, 1.5, 0}) * truth.rotation, truth.translation};
  EXPECT_GT(match.evidence, pairs.refined(0, 1, wrong).evidence + 1);
  EXPECT_NEAR(match.evidence, pairs.refined(0, 1, truth).evidence, 0.1);
}

}  // namespace
}  // namespace polar
