#include "polar/fusion/cuts.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {
namespace {

// Points in a ball of radius 1 and the template they were drawn from.
Eigen::Matrix3Xf ball(Eigen::Index count, std::uint64_t key) {
  KeyedRandom random(1, key, 1);
  Eigen::Matrix3Xf out(3, count);
  for (Eigen::Index k = 0; k < count; ++k)
    out.col(k) = (std::cbrt(random.uniform()) * random.direction()).cast<float>();
  return out;
}

Mixture template_of(const Eigen::Matrix3Xf& centre) {
  Mixture m;
  m.centre = centre;
  m.weight = Eigen::VectorXf::Constant(centre.cols(), 1.0f / static_cast<float>(centre.cols()));
  return m;
}

// What of the points lies below a plane.
Eigen::Matrix3Xf cut_at(const Eigen::Matrix3Xf& points, const Eigen::Vector3f& normal, float offset) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    if (normal.dot(points.col(k)) <= offset) kept.push_back(k);
  return points(Eigen::all, kept);
}

TEST(Cuts, theShareThatAPlaneLeavesIsFoundInAnyPose) {
  const CutTable cuts(template_of(ball(2000, 1)));
  for (std::uint64_t key = 0; key < 8; ++key) {
    KeyedRandom random(2, key, 1);
    const Pose template_from_view{random.rotation(), 0.2 * random.direction()};
    const Eigen::Vector3f normal = random.direction().cast<float>();
    const auto offset = static_cast<float>(-0.2 + 0.5 * random.uniform());
    const Eigen::Matrix3Xf whole = ball(2000, 10 + key);
    Eigen::Matrix3Xf view = cut_at(whole, normal, offset);
    const double truth = static_cast<double>(view.cols()) / 2000;
    const Eigen::Matrix3f back = template_from_view.rotation.transpose().cast<float>();
    view = back * (view.colwise() - template_from_view.translation.cast<float>());
    const double share = cuts.likeliest(reach_of(view), template_from_view).visible;
    // The nearest of the directions is up to 10 degrees off the plane's normal. Across the ball's rim, along
    // it, a view then reaches sin(10 degrees) = 0.17 farther, over a slab of 0.75 x 0.17 of the mass or less.
    EXPECT_GT(share, truth - 0.04) << key;
    EXPECT_LT(share, truth + 0.10) << key;
    const Cut cut = cuts.likeliest(reach_of(view), template_from_view);
    const Eigen::Vector3d found = template_from_view.rotation * cut.normal.cast<double>();
    EXPECT_GT(found.dot(normal.cast<double>()), 0.9) << key;
  }
}

TEST(Cuts, aWholeViewGainsNothing) {
  const CutTable cuts(template_of(ball(2000, 1)));
  const float share = cuts.likeliest(reach_of(ball(1000, 2)), Pose{}).visible;
  EXPECT_GT(share, 0.95f);
  EXPECT_LT(CutTable::gain(share, 1000), 50.0f);
  EXPECT_NEAR(CutTable::gain(0.5f, 1000), 693.1f, 0.1f);
  EXPECT_EQ(CutTable::gain(0.0f, 10), CutTable::gain(kLeastShown, 10));
}

TEST(Cuts, manyTranslationsScoreAsEachOfThem) {
  const CutTable cuts(template_of(ball(1000, 1)));
  const ViewReach reach = reach_of(cut_at(ball(1000, 3), Eigen::Vector3f::UnitX(), 0.1f));
  const std::vector<Eigen::Vector3f> shifts = {
      {-0.1f, 0, 0}, {0, -0.1f, 0}, {0, 0, 0}, {0, 0.1f, 0}, {0.1f, 0, 0}};
  std::vector<float> share(shifts.size());
  cuts.visible(reach, Eigen::Matrix3f::Identity(), shifts, share.data());
  for (std::size_t t = 0; t < shifts.size(); ++t)
    EXPECT_NEAR(share[t],
                cuts.likeliest(reach, Pose{Eigen::Matrix3d::Identity(), shifts[t].cast<double>()}).visible,
                0.02f)
        << t;
}

}  // namespace
}  // namespace polar
