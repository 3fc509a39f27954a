#include "latent/fused_template.hpp"

#include <gtest/gtest.h>

#include "fixture.hpp"
#include "latent/mask.hpp"

namespace polar {
namespace {

constexpr int kCount = 800;

LatentViews fused_views(const Views& views, double outlier_fraction = 0) {
  static const auto model = fixture::shipped();
  LatentOptions options;
  options.outlier_fraction = outlier_fraction;
  return latent_views(views, *model, options);
}

std::vector<Pose> scaled(std::vector<Pose> poses, double scale) {
  for (Pose& p : poses) p.translation *= scale;
  return poses;
}

std::vector<int> all_of(const LatentViews& views) {
  return best_views(views, std::vector<double>(views.view.size(), 1), 1);
}

TEST(FusedTemplate, takesNoiseAway) {
  const fixture::Posed p = fixture::posed_views(30, 400, 0.03f, 0.15f, 4);
  const LatentViews views = fused_views(p.views);
  const std::vector<Pose> pose = scaled(p.view_from_structure, views.scale);
  const Eigen::Matrix3Xf structure = static_cast<float>(views.scale) * fixture::three_bars(4000, 77);
  const Eigen::Matrix3Xf fused = fused_template(views, all_of(views), pose, kCount, 1, 0);
  const Eigen::Matrix3Xf plain = pose[0].rotation.cast<float>().transpose() *
                                 (views.view[0].points.colwise() - pose[0].translation.cast<float>());
  ASSERT_EQ(fused.cols(), kCount);
  const float off = nearest_distances(fused, structure).mean(),
              before = nearest_distances(plain, structure).mean();
  EXPECT_LT(off, 0.6f * before);
  EXPECT_LT(nearest_distances(structure, fused).mean(), 0.08f);  // and no part of it is lost
}

TEST(FusedTemplate, leavesOutWhatOnlyOneViewShows) {
  fixture::Posed p = fixture::posed_views(20, 300, 0.02f, 0.02f, 9);
  KeyedRandom random(3, 0, 1);
  for (std::size_t i = 0; i < p.views.view.size(); ++i) {  // a third of each view: a rod of its own, outside
    const Eigen::Vector3d at = 1.2 * random.direction(), along = random.direction();
    for (Eigen::Index j = 0; j < 100; ++j)
      p.views.view[i].points.col(j) =
          (p.view_from_structure[i] * (at + 0.6 * (random.uniform() - 0.5) * along)).cast<float>();
  }
  const auto foreign = [&](double told) {
    const LatentViews views = fused_views(p.views, told);
    const Eigen::Matrix3Xf structure = static_cast<float>(views.scale) * fixture::three_bars(4000, 77);
    const Eigen::Matrix3Xf fused =
        fused_template(views, all_of(views), scaled(p.view_from_structure, views.scale), kCount, 1, 0);
    return (nearest_distances(fused, structure).array() > 0.15f).cast<float>().mean();
  };
  EXPECT_GT(foreign(0), 0.15f);
  EXPECT_LT(foreign(1.0 / 3), 0.08f);
}

TEST(BestViews, areTheOnesOfLowestLossThatShowAnything) {
  LatentViews views;
  views.view.resize(5);
  for (const std::size_t i : {0u, 1u, 3u, 4u}) views.view[i].points = Eigen::Matrix3Xf::Zero(3, 1);
  EXPECT_EQ(best_views(views, {4, 3, 0, 1, 2}, 0.5), (std::vector<int>{3, 4}));
  EXPECT_EQ(best_views(views, {4, 3, 0, 1, 2}, 1), (std::vector<int>{0, 1, 3, 4}));
}

}  // namespace
}  // namespace polar
