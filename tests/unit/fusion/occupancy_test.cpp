#include "polar/fusion/occupancy.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"

namespace polar {
namespace {

constexpr int kSites = 24;

// The strength that is likeliest for views which each show the sites that `shown` says.
template <typename Shown>
double strength_of(Shown shown) {
  Mixture mixture = fixture::random_mixture(kSites, 11);
  mixture.outlier_fraction = 0.02;
  Views views;
  std::vector<Pose> pose;
  for (std::uint64_t i = 0; i < 30; ++i) {
    Mixture part = mixture;
    KeyedRandom random(3, i, 1);
    for (Eigen::Index k = 0; k < part.size(); ++k)
      if (!shown(random)) part.weight[k] = 0;
    part.weight /= part.weight.sum();
    pose.push_back(fixture::random_pose(i));
    views.view.push_back(fixture::draw_view(part, pose.back(), 200, 0.03f, 0.03f, 40 + i));
  }
  const std::vector<Eigen::Vector3f> axes(views.view.size(), Eigen::Vector3f::UnitZ());
  NoiseModel noise;
  noise.width = 0.01;
  return likeliest_strength(mixture, FusionData(views, axes, noise), pose, 0.05);
}

TEST(LikeliestStrength, isLargeWhereEveryViewShowsTheTemplateAsItIs) {
  EXPECT_GE(strength_of([](KeyedRandom&) { return true; }), 512.0 / kSites);
}

TEST(LikeliestStrength, isSmallWhereEveryViewShowsHalfOfTheSites) {
  // Of about 8 localisations a site: the view is to be trusted more than the template.
  EXPECT_LE(strength_of([](KeyedRandom& random) { return random.uniform() < 0.5; }), 1);
}

}  // namespace
}  // namespace polar
