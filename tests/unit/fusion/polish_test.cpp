#include "polar/fusion/polish.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "fixture.hpp"

namespace polar {
namespace {

constexpr int kLocalisations = 300;
constexpr std::size_t kViews = 10;

// Views whose every localisation is there `copies` times in a row.
struct Copied {
  explicit Copied(int copies, bool planar = false) : mixture(fixture::random_mixture(24, 11, planar)) {
    mixture.outlier_fraction = 0.02;
    NoiseModel noise;
    noise.planar = views.planar = planar;
    for (std::size_t i = 0; i < kViews; ++i) {
      pose.push_back(fixture::random_pose(100 + i, planar));
      const View once =
          fixture::draw_view(mixture, pose.back(), kLocalisations, 0.04f, 0.08f, 100 + i, planar);
      View many;
      many.points.resize(3, kLocalisations * copies);
      for (int j = 0; j < kLocalisations * copies; ++j) {
        many.points.col(j) = once.points.col(j / copies);
        many.covariance.push_back(once.covariance[static_cast<std::size_t>(j / copies)]);
      }
      views.view.push_back(std::move(many));
    }
    const std::vector<Eigen::Vector3f> axes(kViews, Eigen::Vector3f::UnitZ());
    data = std::make_unique<FusionData>(views, axes, noise);
  }
  std::vector<PolishedPose> polished(const std::vector<std::vector<int>>& burst = {}) const {
    return polish(mixture, *data, pose, burst);
  }
  Mixture mixture;
  Views views;
  std::vector<Pose> pose;
  std::unique_ptr<FusionData> data;
};

// For every view the bursts of `per_burst` localisations that follow each other.
std::vector<std::vector<int>> bursts_of(int per_burst, int localisations) {
  std::vector<int> burst;
  for (int j = 0; j < localisations; ++j) burst.push_back(j / per_burst);
  return std::vector<std::vector<int>>(kViews, burst);
}

class PolishOfBursts : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, PolishOfBursts, ::testing::Values(false, true),
                         [](const auto& dimension) { return dimension.param ? "planar" : "spatial"; });

TEST_P(PolishOfBursts, theCovarianceGrowsAndTheLikelihoodIsTemperedByTheCopies) {
  constexpr int kCopies = 4;
  const Copied scene(kCopies, GetParam());
  const auto apart = scene.polished(),
             together = scene.polished(bursts_of(kCopies, kCopies * kLocalisations));
  double growth = 0, temper = 0;
  for (std::size_t i = 0; i < kViews; ++i) {
    EXPECT_EQ(together[i].template_from_view.rotation, apart[i].template_from_view.rotation) << i;
    EXPECT_EQ(apart[i].temper, 1) << i;
    growth += together[i].covariance.trace() / apart[i].covariance.trace() / kViews;
    temper += together[i].temper / kViews;
  }
  // Of 300 bursts a view and ten views: the outer products of gradients say it to a few per cent.
  EXPECT_NEAR(growth, kCopies, 0.1 * kCopies);
  EXPECT_NEAR(temper, 1.0 / kCopies, 0.1 / kCopies);
}

TEST_P(PolishOfBursts, copiesInOneBurstSayWhatOneOfThemSays) {
  constexpr int kCopies = 3;
  const auto once =
      Copied(1, GetParam())
          .polished(std::vector<std::vector<int>>(kViews, std::vector<int>(kLocalisations, -1)));
  const auto many = Copied(kCopies, GetParam()).polished(bursts_of(kCopies, kCopies * kLocalisations));
  for (std::size_t i = 0; i < kViews; ++i) {
    EXPECT_GT(once[i].temper, 0.8) << i;  // localisations of their own count in full, but for chance
    if (once[i].temper < 1) {
      EXPECT_NEAR(many[i].temper, once[i].temper / kCopies, 0.02 / kCopies) << i;
    }
    EXPECT_LT(many[i].covariance.trace(), 1.05 * once[i].covariance.trace()) << i;
    EXPECT_GT(many[i].covariance.trace(), 0.8 * once[i].covariance.trace()) << i;
  }
}

TEST(PolishOfFewBursts, areNotEnoughToSayHowTheySpread) {
  const Copied scene(1);
  const auto plain = scene.polished(), six = scene.polished(bursts_of(kLocalisations / 6, kLocalisations));
  for (std::size_t i = 0; i < kViews; ++i) {
    EXPECT_EQ(six[i].covariance, plain[i].covariance) << i;
    EXPECT_EQ(six[i].temper, 1) << i;
  }
}

}  // namespace
}  // namespace polar
