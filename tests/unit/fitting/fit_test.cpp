#include "polar/fitting/fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fitting/likelihood.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "support/geometric_models.hpp"

namespace polar::fitting {
namespace {

using polar::testing::ring_model;
using polar::testing::two_rings_model;

constexpr double kBurstDistance = 3.4;  // the default

Simulation pores(int particles, std::uint64_t seed) {
  SimulationOptions o;
  o.particles = particles, o.seed = seed, o.blinks_mean = 4, o.cramer_rao = false, o.outlier_fraction = 0.05;
  return simulate(make_structure({"nuclear_pore"}), o);
}

// Bounds of a binomial count: what leaves out 0.1 % on each side.
void expect_coverage(int inside, int of, double share) {
  const double sd = std::sqrt(of * share * (1 - share));
  EXPECT_GE(inside, of * share - 3.1 * sd) << "of " << of;
}

TEST(Likelihood, DerivativesAreThoseOfTheDensity) {
  const GeometricModel model = two_rings_model();
  const FitData data = particles_of(testing::aligned_truth(pores(1, 3)), kBurstDistance, 1)[0];
  Eigen::VectorXd theta(model.parameter.size() + kPlacement);
  theta << 4, 0.1, 50, 45, 0.05, -0.1, 0.02, 1, -2, 0.5;
  const Pose pose{so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}};
  const Counts counts = counts_for(model, {theta.data(), theta.data() + 4}, 3);
  const GroupScores analytic = group_scores(data, density_of(model, counts, pose, theta, true));
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    Eigen::VectorXd up = theta, down = theta;
    const double h = 1e-5;
    up[i] += h, down[i] -= h;
    const Eigen::VectorXd numeric =
        (group_scores(data, density_of(model, counts, pose, up, false)).log_density -
         group_scores(data, density_of(model, counts, pose, down, false)).log_density) /
        (2 * h);
    // Central differences of sums of some hundred: 1e-10 of rounding over h.
    EXPECT_LT((analytic.gradient.row(i).transpose() - numeric).cwiseAbs().maxCoeff(),
              1e-4 * (1 + numeric.cwiseAbs().maxCoeff()))
        << "parameter " << i;
  }
}

TEST(Fit, FindsARingAsImagedAnywhere) {
  SimulationOptions o;
  o.particles = 1, o.seed = 4, o.translation_nm = 1000, o.label_size_nm = 1;
  StructureOptions s{"ring"};
  s.radius_nm = 70, s.units = 40;
  const FitData data = particles_of(simulate(make_structure(s), o).table, kBurstDistance, 1)[0];
  const ModelFit fit = fit_from_starts(ring_model(), data, {});
  ASSERT_EQ(fit.reason, "");
  EXPECT_NEAR(fit.value[2], 70, 4 * fit.std_error(2));
  EXPECT_LT(fit.std_error(2), 2);
}

// Of particles of one geometry the truth lies within 1.96 standard errors as often as they say.
TEST(Fit, StandardErrorsCoverTheTruth) {
  const int particles = 80;
  const smlm::LocalisationTable table = testing::aligned_truth(pores(particles, 5));
  const std::vector<FitData> data = particles_of(table, kBurstDistance, 1);
  const GeometricModel model = two_rings_model();
  const ModelFit all = fit_from_starts(model, superparticle_of(data), {});
  ASSERT_EQ(all.reason, "");
  EXPECT_NEAR(all.value[2], 53.5, 4 * all.std_error(2));
  EXPECT_NEAR(all.value[3], 50, 4 * all.std_error(3));
  int radius = 0, distance = 0;
  double squares = 0;
  for (const FitData& d : data) {
    const ModelFit fit = fit_near(model, d, all, {});
    ASSERT_EQ(fit.reason, "");
    const double r = (fit.value[2] - 53.5) / fit.std_error(2), h = (fit.value[3] - 50) / fit.std_error(3);
    radius += std::abs(r) < 1.96, distance += std::abs(h) < 1.96;
    squares += r * r + h * h;
  }
  expect_coverage(radius, particles, 0.95);
  expect_coverage(distance, particles, 0.95);
  EXPECT_GT(squares / (2 * particles), 0.5);  // nor are they far too large
}

TEST(Fit, HoldsWhatIsSharedAndThePoseIfAsked) {
  const std::vector<FitData> data = particles_of(testing::aligned_truth(pores(6, 6)), kBurstDistance, 1);
  const GeometricModel model = two_rings_model();
  const ModelFit all = fit_from_starts(model, superparticle_of(data), {});
  FitOptions fixed;
  fixed.free_pose = false;
  const ModelFit one = fit_near(model, data[0], all, fixed);
  EXPECT_EQ(one.value[kWidth], all.value[kWidth]);
  EXPECT_TRUE(std::isnan(one.std_error(kWidth)));
  EXPECT_EQ(one.data_from_model.translation, all.data_from_model.translation);
}

TEST(Fit, SaysWhatTheDataLeaveOpen) {
  SimulationOptions o;
  o.particles = 1, o.planar = true, o.orientation = "in_plane";
  const FitData data =
      particles_of(simulate(make_structure({"nuclear_pore"}), o).table, kBurstDistance, 1)[0];
  const ModelFit fit = fit_from_starts(two_rings_model(), data, {});
  EXPECT_NEAR(fit.value[2], 53.5, 5);
  EXPECT_TRUE(fit.at_bound[3] || std::isnan(fit.std_error(3)));  // without z the rings' distance is open
}

TEST(Fit, SameBitsForAnyNumberOfThreads) {
  const FitData data = superparticle_of(particles_of(testing::aligned_truth(pores(4, 7)), kBurstDistance, 1));
  FitOptions o;
  o.starts = 3;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return fit_from_starts(two_rings_model(), data, o);
  };
  const ModelFit one = with(1), two = with(2);
  EXPECT_EQ(one.value, two.value);
  EXPECT_EQ(one.covariance, two.covariance);
}

}  // namespace
}  // namespace polar::fitting
