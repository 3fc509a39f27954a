#include "latent/crops.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"
#include "latent/flames_search.hpp"
#include "latent/mask.hpp"
#include "polar/core/constants.hpp"

namespace polar {
namespace {

TEST(PlaneCrops, keepTheShareOnOneSideAboutItsOwnCentre) {
  const Eigen::Matrix3Xf bars = fixture::three_bars(500, 2);
  for (const Crop& c : plane_crops(bars, 0.8, 6, 1000, false)) {
    ASSERT_EQ(c.kept.size(), 400u);
    EXPECT_LT(c.points.rowwise().mean().norm(), 1e-4f);
    EXPECT_LT(((columns(bars, c.kept).colwise() - c.centre) - c.points).norm(), 1e-5f);
    EXPECT_GT((c.centre - bars.rowwise().mean()).norm(), 0.02f);
  }
  EXPECT_EQ(plane_crops(bars, 0.8, 6, 100, false).front().kept.size(), 100u);
  Eigen::Matrix3Xf pairs(3, 400);  // one above the other: cut in or out together
  for (Eigen::Index j = 0; j < 200; ++j)
    for (const Eigen::Index side : {0, 1})
      pairs.col(2 * j + side) = Eigen::Vector3f(bars(0, j), bars(1, j), side == 0 ? 1.0f : -1.0f);
  for (const Crop& c : plane_crops(pairs, 0.5, 4, 1000, true)) EXPECT_NEAR(c.centre.z(), 0, 0.0051);
}

// Views without a fifth of the bars, about the centre of what is left, under the true template.
TEST(Flames, findsTheBasinOfACroppedView) {
  constexpr int kViews = 30;
  constexpr double kVisible = 0.8, kNear_deg = 25;  // half the grid's spacing and more: descent does the rest
  fixture::Posed p = fixture::posed_views(kViews, 400, 0.02f, 0.02f, 12);
  for (std::size_t i = 0; i < p.views.view.size(); ++i) {
    KeyedRandom random(12, i, 9);
    View& view = p.views.view[i];
    const Eigen::VectorXf along = view.points.transpose() * random.direction().cast<float>();
    const std::vector<int> kept = nearest_share(along, kVisible);
    view.points = columns(view.points, kept).eval();
    const Eigen::Vector3f centre = view.points.rowwise().mean();
    view.points.colwise() -= centre;
    view.covariance.resize(kept.size());
  }
  const auto model = fixture::shipped();
  LatentOptions options;
  options.visibility = kVisible;
  options.localisations = 256;
  const LatentViews views = latent_views(p.views, *model, options);
  const Eigen::Matrix3Xf structure = static_cast<float>(views.scale) * fixture::three_bars(1024, 78);
  const auto minima = flames(*model, views, noise_classes(views, options), latent_grid(options, false),
                             Eigen::Matrix3f::Identity(), structure, std::vector<Pose>(kViews), 8);
  int found = 0;
  for (std::size_t i = 0; i < kViews; ++i)
    for (const Minimum& m : minima[i])
      if (geodesic_angle(m.view_from_template.rotation, p.view_from_structure[i].rotation) <
          kNear_deg * kRadiansPerDegree) {
        ++found;
        break;
      }
  EXPECT_GE(found, 27);  // without crops 24
}

}  // namespace
}  // namespace polar
