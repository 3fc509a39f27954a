#include "polar/fusion/density_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/isa.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {
namespace {

constexpr double kOutliers = 0.1, kOutlierDensity = 0.2;

class Grid : public ::testing::TestWithParam<bool> {
 protected:
  bool planar() const { return GetParam(); }
  VoxelFrame frame(double reach = 1, double voxel = 0.1) const { return {reach, voxel, planar()}; }
  int axes() const { return planar() ? 2 : 3; }

  Eigen::Vector3f somewhere(KeyedRandom& random, double radius) const {
    Eigen::Vector3d x = radius * std::cbrt(random.uniform()) * random.direction();
    if (planar()) x.z() = 0;
    return x.cast<float>();
  }
  LookupPoints cloud(int count, double radius, std::uint64_t key) const {
    KeyedRandom random(1, key, 1);
    LookupPoints out;
    for (int j = 0; j < count; ++j) out.add(somewhere(random, radius));
    out.pad();
    return out;
  }
  Eigen::Matrix3f turn(std::uint64_t key) const {
    KeyedRandom random(2, key, 1);
    if (!planar()) return random.rotation().cast<float>();
    return so3_exp({0, 0, 6 * random.uniform()}).cast<float>();
  }
  DensityGrid blob() const {
    VoxelCounts counts(frame());
    counts.add(cloud(500, 0.7, 3), Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(), 1);
    DensityGrid density(counts);
    density.blur(0.1);
    density.normalise();
    return density;
  }
};
INSTANTIATE_TEST_SUITE_P(Dimensions, Grid, ::testing::Values(false, true),
                         [](const auto& dimension) { return dimension.param ? "planar" : "spatial"; });

double mass_of(const DensityGrid& d) {
  return std::accumulate(d.value().begin(), d.value().end(), 0.0,
                         [](double sum, float v) { return sum + static_cast<double>(v); });
}

Eigen::Vector3d variance_of(const DensityGrid& d) {
  const Eigen::Vector3d mean = d.centroid();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < d.value().size(); ++v)
    sum += static_cast<double>(d.value()[v]) * (d.position(v).cast<double>() - mean).cwiseAbs2();
  return sum / mass_of(d);
}

// One count at the voxel nearest to the origin.
DensityGrid spot(const VoxelFrame& frame) {
  LookupPoints point;
  point.add(Eigen::Vector3f(0.01f, 0.01f, frame.planar() ? 0 : 0.01f));
  VoxelCounts counts(frame);
  counts.add(point, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(), 1);
  return DensityGrid(counts);
}

TEST_P(Grid, scoresAreTheSumOverNearestVoxelsInEveryInstructionSet) {
  const DensityGrid density = blob();
  const VoxelFrame& f = density.frame();
  const Eigen::Matrix3f r = turn(4);
  const Eigen::Vector3f t = planar() ? Eigen::Vector3f(0.1f, -0.2f, 0) : Eigen::Vector3f(0.1f, -0.2f, 0.15f);
  // Every point lands within 0.4 voxels of a voxel's centre, so that rounding cannot decide which is nearest;
  // shifts are whole voxels. More points than one batch, not a multiple of 16, some of them outside.
  constexpr int kPoints = 300;
  KeyedRandom random(5, 0, 1);
  LookupPoints points;
  for (int j = 0; j < kPoints; ++j) {
    Eigen::Vector3f y = f.origin;
    for (int a = 0; a < axes(); ++a) {
      const auto voxel = static_cast<float>(random.below(static_cast<std::uint64_t>(f.dim[a]) + 4)) - 2;
      y[a] += f.voxel * (voxel + static_cast<float>(0.8 * random.uniform() - 0.4));
    }
    points.add(r.transpose() * (y - t));
  }
  points.pad();
  std::vector<Eigen::Vector3f> shift;
  for (int s = 0; s < 70; ++s) {  // more than are looked up at a time
    Eigen::Vector3f whole = Eigen::Vector3f::Zero();
    for (int a = 0; a < axes(); ++a) whole[a] = static_cast<float>(random.below(7)) - 3;
    shift.push_back(t + f.voxel * whole);
  }
  const double background = kOutliers * kOutlierDensity;
  const auto log_of = [&](const Eigen::Vector3f& y) {
    std::size_t voxel = 0;
    for (int a = 2; a >= 0; --a) {
      const auto q = static_cast<int>(std::lround((y[a] - f.origin[a]) / f.voxel));
      voxel = voxel * static_cast<std::size_t>(f.dim[a]) +
              static_cast<std::size_t>(std::clamp(q, 0, f.dim[a] - 1));  // outside: the border's
    }
    return std::log((1 - kOutliers) * static_cast<double>(density.value()[voxel]) + background);
  };
  const float highest = *std::max_element(density.value().begin(), density.value().end());
  const double range =
      std::max(1.0, std::log(((1 - kOutliers) * static_cast<double>(highest) + background) / background));
  const double half_step = 0.5 * range / 32000;
  for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
    if (detected_isa() < isa) continue;
    limit_isa(isa);
    const LogVolume volume(density, kOutliers, kOutlierDensity);
    std::vector<float> score(shift.size());
    volume.scores(points, r, shift.data(), shift.size(), score.data());
    for (std::size_t s = 0; s < shift.size(); ++s) {
      double direct = 0;
      for (std::size_t j = 0; j < kPoints; ++j)
        direct += log_of(r * Eigen::Vector3f(points.x[j], points.y[j], points.z[j]) + shift[s]);
      EXPECT_NEAR(score[s], direct, kPoints * half_step + 1e-3) << name(isa) << ", shift " << s;
      EXPECT_EQ(score[s], volume.score(points, r, shift[s])) << name(isa) << ", shift " << s;
    }
    EXPECT_GT(*std::max_element(score.begin(), score.end()) - *std::min_element(score.begin(), score.end()),
              1);
  }
  limit_isa(Isa::avx512);
}

TEST_P(Grid, blurKeepsTheMassAndAddsTheVarianceAskedFor) {
  DensityGrid d = spot(frame(1, 0.05));
  const Eigen::Vector3d middle = d.centroid();
  double variance = 0;
  for (const double sigma : {0.1, 0.15}) {
    d.blur(sigma);
    variance += sigma * sigma;
    EXPECT_NEAR(mass_of(d), 1, 1e-5);
    EXPECT_LT((d.centroid() - middle).norm(), 1e-5);
    // Drawn to 3 standard deviations, which leaves out 2.7 % of the variance at most.
    for (int a = 0; a < axes(); ++a) EXPECT_NEAR(variance_of(d)[a], variance, 0.03 * variance) << a;
  }
  if (planar()) {
    EXPECT_EQ(variance_of(d).z(), 0);
  }
}

TEST_P(Grid, aBlurThatIsNarrowerThanVoxelsShowChangesNothing) {
  DensityGrid d = spot(frame());
  d.blur(0.019);
  EXPECT_EQ(d.value(), spot(frame()).value());
}

TEST_P(Grid, capLeavesTheShareAskedForAboveItAndTheOrderOfVoxels) {
  const DensityGrid before = blob();
  float last = *std::max_element(before.value().begin(), before.value().end());
  for (const double share : {0.0, 0.02, 0.1, 0.4}) {
    DensityGrid d = before;
    d.cap(share);
    const float ceiling = *std::max_element(d.value().begin(), d.value().end());
    for (std::size_t v = 0; v < d.value().size(); ++v)
      ASSERT_EQ(d.value()[v], std::min(before.value()[v], ceiling)) << v;
    EXPECT_NEAR(1 - mass_of(d) / mass_of(before), share, 1e-4);
    if (share == 0) {
      EXPECT_EQ(d.value(), before.value());
    } else {
      EXPECT_LT(ceiling, last) << share;
    }
    last = ceiling;
  }
}

TEST_P(Grid, normalisedIntegratesToOneAndIsNowhereBelowTheLeast) {
  DensityGrid d = spot(frame());
  d.blur(0.1);
  d.normalise(0);
  EXPECT_NEAR(mass_of(d) * std::pow(0.1, axes()), 1, 1e-5);
  EXPECT_EQ(*std::min_element(d.value().begin(), d.value().end()), 0);
  d.normalise(1e-3f);
  EXPECT_EQ(*std::min_element(d.value().begin(), d.value().end()), 1e-3f);
}

TEST_P(Grid, countsDoNotDependOnTheOrderOfAdding) {
  constexpr std::uint64_t kViews = 5;
  const auto add = [&](std::uint64_t view, VoxelCounts& counts) {
    counts.add(cloud(37, 1.2, 20 + view), turn(view), Eigen::Vector3f(0.1f, 0, 0),
               static_cast<std::uint32_t>(1 + 1000 * view));
  };
  VoxelCounts forwards(frame()), backwards(frame()), even(frame()), odd(frame());
  for (std::uint64_t i = 0; i < kViews; ++i) {
    add(i, forwards), add(kViews - 1 - i, backwards);
    add(i, i % 2 == 0 ? even : odd);
  }
  even += odd;
  EXPECT_EQ(forwards.count(), backwards.count());
  EXPECT_EQ(forwards.count(), even.count());
}

TEST_P(Grid, everyPointInsideCountsOnceWithItsWeightAndNoneOutside) {
  LookupPoints points = cloud(37, 0.8, 6);
  points.x[0] = 5, points.y[1] = -5;
  VoxelCounts counts(frame());
  counts.add(points, turn(7), Eigen::Vector3f::Zero(),
             3);  // padding, repeats of the last, counts for nothing
  EXPECT_EQ(std::accumulate(counts.count().begin(), counts.count().end(), 0u), 3u * 35u);
}

TEST_P(Grid, readingBetweenVoxelsIsExactForALinearField) {
  const VoxelFrame f = frame(0.5);
  const Eigen::Vector3f slope(3, 5, planar() ? 0 : 7);
  VoxelCounts counts(f);
  const DensityGrid empty(f);
  for (std::size_t v = 0; v < f.size(); ++v) {
    const Eigen::Vector3f at = empty.position(v), index = (at - f.origin) / f.voxel;
    LookupPoints one;
    one.add(at);
    counts.add(one, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(),
               static_cast<std::uint32_t>(std::lround(2 + slope.dot(index))));
  }
  const DensityGrid linear(counts);
  const float half = 0.5f * f.voxel * static_cast<float>(f.dim[0] - 1);
  KeyedRandom random(8, 0, 1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f x = somewhere(random, static_cast<double>(half) * 0.99);
    EXPECT_NEAR(linear.at(x), 2 + slope.dot((x - f.origin) / f.voxel), 2e-4f) << x.transpose();
  }
  for (int a = 0; a < axes(); ++a)
    for (const float sign : {-1.0f, 1.0f})
      EXPECT_EQ(linear.at(sign * (half + 0.01f) * Eigen::Vector3f::Unit(a)), 0) << a;
  if (planar()) {
    EXPECT_EQ(linear.at({0.1f, 0.1f, 5}), linear.at({0.1f, 0.1f, 0})) << "z says nothing";
  }
}

}  // namespace
// Which mode of a posterior is drawn must not hang on the processor.
TEST(LogVolume, SameBitsOnEveryInstructionSet) {
  const VoxelFrame frame(1.8, 0.075, false);
  KeyedRandom random(1, 2, 3);
  LookupPoints points;
  for (int i = 0; i < 117; ++i)
    points.add(Eigen::Vector3d(random.normal(), random.normal(), random.normal()).cast<float>());
  points.pad();
  VoxelCounts counts(frame);
  counts.add(points, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero(), 48);
  const auto scores_on = [&](Isa isa) {
    limit_isa(isa);
    DensityGrid density(counts);
    density.blur(0.1);
    density.normalise();
    const LogVolume volume(density, 0.05, 0.1);
    KeyedRandom turns(4, 5, 6);
    std::vector<float> out;
    for (int i = 0; i < 200; ++i)
      out.push_back(
          volume.score(points, turns.rotation().cast<float>(), Eigen::Vector3f(0.01f, 0.02f, 0.03f)));
    limit_isa(detected_isa());
    return out;
  };
  const std::vector<float> portable = scores_on(Isa::portable);
  EXPECT_EQ(portable, scores_on(Isa::avx2));
  EXPECT_EQ(portable, scores_on(Isa::avx512));
}

}  // namespace polar
