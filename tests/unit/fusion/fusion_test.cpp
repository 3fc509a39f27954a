#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixture.hpp"
#include "fusion/mixture_kernel_choice.hpp"
#include "fusion/voxel_gaussian.hpp"
#include "polar/core/isa.hpp"
#include "polar/fusion/calibration.hpp"
#include "polar/fusion/direction_volumes.hpp"
#include "polar/fusion/discretise.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/polish.hpp"
#include "polar/fusion/pose_search.hpp"

namespace polar {
namespace {

using fixture::draw_view;
using fixture::random_mixture;
using fixture::random_pose;

struct Scene {
  Scene(int views, int localisations, float lateral, float axial) : mixture(random_mixture(24, 11)) {
    mixture.outlier_fraction = 0.02;
    for (int i = 0; i < views; ++i) {
      const auto seed = static_cast<std::uint64_t>(100 + i);
      pose.push_back(random_pose(seed));
      set.view.push_back(draw_view(mixture, pose.back(), localisations, lateral, axial, seed));
      axes.push_back(Eigen::Vector3f::UnitZ());
    }
  }
  NoiseModel noise(double width) const {
    NoiseModel n;
    n.width = width;
    return n;
  }
  Mixture mixture;
  Views set;
  std::vector<Pose> pose;
  std::vector<Eigen::Vector3f> axes;
};

double mean_of(const std::vector<double>& v) {
  double s = 0;
  for (const double x : v) s += x / static_cast<double>(v.size());
  return s;
}

TEST(Maximisation, neverLowersTheLikelihoodAndFindsTheSites) {
  const Scene scene(40, 120, 0.03f, 0.08f);
  const FusionData data(scene.set, scene.axes, scene.noise(0.01));
  Mixture m = scene.mixture;
  KeyedRandom random(1, 0, 0);
  for (Eigen::Index k = 0; k < m.size(); ++k) m.centre.col(k) += (0.05 * random.direction()).cast<float>();
  sort_into_blocks(m);
  MaximisationOptions options;
  options.free_weights = true;
  options.support = false;
  options.weakest_share = 0;
  double last = -1e300;
  for (int step = 0; step < 15; ++step) {
    const MaximisationReport r = maximise(m, data, scene.pose, options);
    EXPECT_GT(r.log_likelihood, last - 0.5) << step;  // single-precision sums over 4,800 localisations
    last = r.log_likelihood;
  }
  for (Eigen::Index k = 0; k < scene.mixture.size(); ++k) {
    const float nearest = (m.centre.colwise() - scene.mixture.centre.col(k)).colwise().norm().minCoeff();
    EXPECT_LT(nearest, 0.03f) << k;
  }
}

TEST(Maximisation, aCentreThatOneViewAloneSupportsLosesItsWeight) {
  Scene scene(20, 60, 0.03f, 0.05f);
  View& crowded = scene.set.view[0];  // forty more localisations on a strand of its own
  const Eigen::Index n = crowded.points.cols();
  crowded.points.conservativeResize(3, n + 40);
  for (Eigen::Index j = n; j < n + 40; ++j) {
    crowded.points.col(j) = (scene.pose[0].inverse() * Eigen::Vector3d(1.4, 0, 0)).cast<float>();
    crowded.covariance.push_back(crowded.covariance.front());
  }
  Mixture m = scene.mixture;
  m.centre.conservativeResize(3, m.size() + 1);
  m.centre.col(m.centre.cols() - 1) = Eigen::Vector3f(1.4f, 0, 0);
  m.weight = Eigen::VectorXf::Constant(m.size(), 1.0f / static_cast<float>(m.size()));
  sort_into_blocks(m);
  MaximisationOptions options;
  options.weakest_share = 0;
  const FusionData data(scene.set, scene.axes, scene.noise(0.02));
  for (int step = 0; step < 3; ++step) maximise(m, data, scene.pose, options);
  Eigen::Index strand = 0;
  (m.centre.colwise() - Eigen::Vector3f(1.4f, 0, 0)).colwise().norm().minCoeff(&strand);
  EXPECT_LT(m.weight[strand], 0.1f / static_cast<float>(m.size()));
}

TEST(DirectionVolumes, scoresRankPosesAsTheMixtureDoes) {
  const Scene scene(1, 200, 0.05f, 0.12f);
  const NoiseModel noise = scene.noise(0.05);
  const SigmaClasses classes = sigma_classes(scene.set, scene.axes, noise, 2);
  const DirectionVolumes volumes(scene.mixture, classes, directions_for(classes, false), false);
  const SearchView view = search_view(scene.set.view[0], scene.axes[0], noise, classes, {});
  const FusionData data(scene.set, scene.axes, noise);
  // Nearest voxel and nearest of 64 directions blur a score, but must not reorder poses: correlation over
  // poses.
  std::vector<double> looked_up, exact;
  for (int i = 0; i < 60; ++i) {
    const Pose pose = i < 5 ? Pose{so3_exp({0.05 * i, 0, 0}), {0, 0, 0}} * scene.pose[0]
                            : random_pose(static_cast<std::uint64_t>(500 + i));
    const Eigen::Matrix3f r = pose.rotation.cast<float>();
    looked_up.push_back(
        double(volumes.score(view, volumes.direction_of(view, r), r, pose.translation.cast<float>())) / 200);
    exact.push_back(mean_log_likelihood(scene.mixture, data, {pose}).front());
  }
  const double a = mean_of(looked_up), b = mean_of(exact);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    ab += (looked_up[i] - a) * (exact[i] - b);
    aa += (looked_up[i] - a) * (looked_up[i] - a);
    bb += (exact[i] - b) * (exact[i] - b);
  }
  EXPECT_GT(ab / std::sqrt(aa * bb), 0.98);
  EXPECT_EQ(std::max_element(exact.begin(), exact.end()) - exact.begin() < 5,
            std::max_element(looked_up.begin(), looked_up.end()) - looked_up.begin() < 5);
}

TEST(DirectionVolumes, aGaussianIsDrawnWhereItReachesInEveryInstructionSet) {
  const int dim[3] = {21, 17, 19};
  Eigen::Matrix3f p;
  p << 0.3f, 0.1f, -0.05f, 0.1f, 0.2f, 0.04f, -0.05f, 0.04f, 0.15f;
  const Eigen::Matrix3f c = p.inverse();
  const float reach = 3.5f;
  const VoxelGaussian gaussian(4 * c, 2, reach, false);
  // Inside, over a border, over a corner, and outside but for its edge.
  for (const Eigen::Vector3f& at : {Eigen::Vector3f(9.3f, 8.6f, 10), Eigen::Vector3f(0.2f, 8, 17.9f),
                                    Eigen::Vector3f(20, 16, 18), Eigen::Vector3f(-4.4f, 5, 5)})
    for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
      if (detected_isa() < isa) continue;
      limit_isa(isa);
      std::vector<float> volume(static_cast<std::size_t>(dim[0] * dim[1] * dim[2] + kernel::kBlock), 1.0f);
      mixture_kernel().add_gaussian(volume.data(), dim, gaussian.at(at, 2));
      const float* v = volume.data();
      int drawn = 0;
      for (int z = 0; z < dim[2]; ++z)
        for (int y = 0; y < dim[1]; ++y)
          for (int x = 0; x < dim[0]; ++x, ++v) {
            const Eigen::Vector3f d = Eigen::Vector3f(float(x), float(y), float(z)) - at;
            const float q = d.dot(p * d), value = q < reach * reach ? 2 * std::exp(-q / 2) : 0;
            if (std::abs(q - reach * reach) < 1e-3f) continue;  // which side it falls on is rounding
            // Tabulated 80 times a standard deviation: at most 3.5 / 160 off.
            EXPECT_NEAR(*v, 1 + value, 0.023f * value + 1e-6f) << name(isa) << at.transpose();
            drawn += value > 0;
          }
      EXPECT_GT(drawn, 5);
      EXPECT_TRUE(std::all_of(v, v + kernel::kBlock, [](float f) { return f == 1; })) << "past the end";
    }
  limit_isa(Isa::avx512);
}

TEST(DirectionVolumes, manyShiftsAtATimeScoreAsEachAloneInEveryInstructionSet) {
  const Scene scene(1, 300, 0.05f, 0.12f);  // more localisations than one batch, not a multiple of 16
  const NoiseModel noise = scene.noise(0.05);
  const SigmaClasses classes = sigma_classes(scene.set, scene.axes, noise, 2);
  const DirectionVolumes volumes(scene.mixture, classes, directions_for(classes, false), false);
  const SearchView view = search_view(scene.set.view[0], scene.axes[0], noise, classes, {});
  const Eigen::Matrix3f r = scene.pose[0].rotation.cast<float>();
  const int direction = volumes.direction_of(view, r);
  std::vector<Eigen::Vector3f> shift;
  for (std::uint64_t i = 0; i < 100; ++i) shift.push_back(4 * random_pose(i).translation.cast<float>());
  for (const Isa isa : {Isa::portable, Isa::avx2, Isa::avx512}) {
    if (detected_isa() < isa) continue;
    limit_isa(isa);
    std::vector<float> together(shift.size());
    volumes.scores(view, direction, r, shift, together.data());
    for (std::size_t s = 0; s < shift.size(); ++s)
      EXPECT_EQ(together[s], volumes.score(view, direction, r, shift[s])) << name(isa) << ", shift " << s;
    EXPECT_GT(*std::max_element(together.begin(), together.end()) -
                  *std::min_element(together.begin(), together.end()),
              1);
  }
  limit_isa(Isa::avx512);
}

TEST(Calibration, recoversWhatTheTableStatesWrongly) {
  Scene scene(60, 100, 0.06f, 0.15f);
  for (View& v : scene.set.view)  // the table states half the true lateral value
    for (Symmetric3& c : v.covariance) c[0] = c[3] = 0.03f * 0.03f;
  Subsets all;
  for (const View& v : scene.set.view) {
    all.emplace_back();
    for (std::uint32_t j = 0; j < v.covariance.size(); ++j) all.back().push_back(j);
  }
  const CalibrationReport r =
      calibrate(scene.set, scene.axes, all, scene.mixture, scene.pose, scene.noise(0.02));
  const double lateral = std::hypot(r.noise.lateral_factor * 0.03, r.noise.lateral_extra);
  const double axial = std::hypot(r.noise.axial_factor * 0.15, r.noise.axial_extra);
  EXPECT_NEAR(lateral, 0.06, 0.004);
  EXPECT_NEAR(axial, 0.15, 0.012);
}

TEST(Discretise, mergesTwinsAndKeepsWeight) {
  Mixture m = random_mixture(20, 3);
  const Mixture single = m;
  m.centre.conservativeResize(3, 40);
  m.weight.conservativeResize(40);
  for (Eigen::Index k = 0; k < 20; ++k) {
    m.centre.col(20 + k) = m.centre.col(k) + Eigen::Vector3f(0.004f, 0, 0);
    m.weight[k] *= 0.5f;
    m.weight[20 + k] = m.weight[k];
  }
  const Mixture out = merged(m, 0.02);
  EXPECT_EQ(out.size(), single.size());
  EXPECT_NEAR(out.weight.sum(), 1, 1e-5);
}

TEST(Occupancy, seesWhichHalfOfTheTemplateAViewShows) {
  Scene scene(1, 400, 0.03f, 0.03f);
  View& v = scene.set.view[0];
  std::vector<std::uint32_t> kept;
  for (std::uint32_t j = 0; j < v.covariance.size(); ++j)
    if ((scene.pose[0] * Eigen::Vector3d(v.points.col(j).cast<double>())).x() > 0) kept.push_back(j);
  const FusionData data(scene.set, scene.axes, scene.noise(0.01), {kept});
  const auto factor = occupancy(scene.mixture, data, scene.pose, 0.1, 0.0);
  for (Eigen::Index k = 0; k < scene.mixture.size(); ++k) {
    const float x = scene.mixture.centre(0, k), f = factor[0][static_cast<std::size_t>(k)];
    if (x > 0.15f) {
      EXPECT_GT(f, 0.7f) << x;
    }
    if (x < -0.15f) {
      EXPECT_LT(f, 0.2f) << x;
    }
  }
  EXPECT_LT(shown_share(scene.mixture, factor[0]), 0.85);
  EXPECT_TRUE(occupancy(scene.mixture, data, scene.pose, INFINITY, 0.0)[0].empty());
}

TEST(Polish, covarianceDescribesTheErrorsThatAreMade) {
  const Scene scene(60, 150, 0.04f, 0.10f);
  const FusionData data(scene.set, scene.axes, scene.noise(0));
  std::vector<Pose> start = scene.pose;
  for (Pose& p : start) p = Pose{so3_exp({0.02, -0.02, 0.02}), {0.01, 0, 0.01}} * p;
  const auto polished = polish(scene.mixture, data, start);
  double chi2 = 0;
  for (std::size_t i = 0; i < polished.size(); ++i) {
    const Pose error = polished[i].template_from_view * scene.pose[i].inverse();
    Eigen::Matrix<double, 6, 1> e;
    e << so3_log(error.rotation), error.translation;
    chi2 += e.dot(polished[i].covariance.ldlt().solve(e)) / static_cast<double>(polished.size());
  }
  // Six degrees of freedom; the mean of 60 has standard error sqrt(12/60) = .45, five of them allowed.
  EXPECT_NEAR(chi2, 6, 2.3);
}

TEST(Polish, poseOnlyClimbs) {
  const Scene scene(10, 80, 0.05f, 0.12f);
  const FusionData data(scene.set, scene.axes, scene.noise(0.01));
  std::vector<Pose> start = scene.pose;
  for (Pose& p : start) p = Pose{so3_exp({0.05, 0.03, -0.04}), {0.02, 0.02, 0}} * p;
  const double before = mean_of(mean_log_likelihood(scene.mixture, data, start));
  std::vector<double> after;
  for (const auto& p : polish(scene.mixture, data, start)) after.push_back(p.log_likelihood);
  EXPECT_GT(mean_of(after), before + 0.05);
}

}  // namespace
}  // namespace polar
