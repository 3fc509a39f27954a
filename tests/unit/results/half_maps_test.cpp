#include "polar/results/half_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/simulation/simulate.hpp"
#include "support/fake_results.hpp"

namespace polar {
namespace {

constexpr double kSigma_nm = 3;

/// Perfectly registered pores; their template is moved by `template_from_structure`.
Results pores(std::uint64_t seed, const Pose& template_from_structure) {
  SimulationOptions o;
  o.seed = seed;
  o.particles = 30;
  o.label_size_nm = 0;
  o.sigma_xy_nm = {kSigma_nm, kSigma_nm};
  o.sigma_z_factor = {1, 1};
  o.labelling_efficiency = 1;
  o.cramer_rao = false;
  const Structure pore = make_structure({});
  Results r = support::perfect_results(simulate(pore, o), pore);
  const double scale_nm = r.normalisation.scale_nm;
  const Pose moved = {template_from_structure.rotation, template_from_structure.translation / scale_nm};
  for (RegisteredView& view : r.registration.view) view.template_from_view = moved * view.template_from_view;
  FusedTemplate& fused = r.registration.fused;
  for (Eigen::Index k = 0; k < fused.centre.cols(); ++k) fused.centre.col(k) = moved * fused.centre.col(k);
  fused.width = std::max(fused.width, 0.02);
  fused.outlier_fraction = 0.02, fused.outlier_density = 0.1;
  return r;
}

TEST(HalfMaps, AreAlignedByTheirMapsAloneAndCorrelateToTheLocalisationPrecision) {
  const Results first = pores(1, {});
  const Pose motion = {KeyedRandom(3, 0, 1).rotation(), {40, -25, 60}};
  const Results second = pores(2, motion);
  const HalfMaps maps = compare_half_maps(first, second, 1);
  const Pose rest = maps.first_from_second_nm * motion;  // an element of D8 about the pore's centre
  double angle_deg = 180;
  for (const Eigen::Matrix3d& g : symmetry_rotations("D8"))
    angle_deg = std::min(angle_deg, kDegreesPerRadian * geodesic_angle(rest.rotation, g));
  EXPECT_LT(angle_deg, 0.5);
  EXPECT_LT(rest.translation.norm(), 0.5);
  // 2 x 16 sites a ring, about n localisations each: an emitter with n of them resolves 2 pi s / sqrt(ln 6
  // n).
  const double per_site = static_cast<double>(first.particles.table.size()) / 32;
  const double emitter_nm = kTwoPi * kSigma_nm / std::sqrt(std::log(6 * per_site));
  EXPECT_NEAR(maps.resolution.period_nm, emitter_nm, 0.15 * emitter_nm);
  EXPECT_EQ(maps.first_particles, 29u);  // perfect_results rejects one
}

TEST(HalfMaps, StructureWithNothingInCommonIsNotResolved) {
  const Results first = pores(1, {});
  Results second = pores(2, {});
  second.particles = noise_particles(std::move(second.particles), 5);
  const HalfMaps maps = compare_half_maps(first, second, 1);
  const double radius_nm = 73;  // of a pore: envelopes may agree, nothing inside them
  EXPECT_FALSE(maps.resolution.period_nm < radius_nm / 2) << maps.resolution.period_nm;
}

TEST(HalfMaps, WithoutAcceptedParticlesNothingIsResolved) {
  const Results first = pores(1, {});
  Results second = pores(2, {});
  for (RegisteredView& v : second.registration.view) v.accepted = false;
  EXPECT_TRUE(std::isnan(compare_half_maps(first, second, 1).resolution.period_nm));
}

TEST(NoiseParticles, KeepPlaceAndExtentButNoStructure) {
  const Results r = pores(1, {});
  const smlm::ParticleSet noise = noise_particles(r.particles, 9);
  ASSERT_EQ(noise.table.size(), r.particles.table.size());
  EXPECT_EQ(noise.table.covariance_nm2, r.particles.table.covariance_nm2);
  const auto moments = [](const smlm::ParticleSet& set) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double square = 0;
    const auto n = static_cast<double>(set.table.size());
    for (const auto& x : set.table.position_nm) mean += Eigen::Vector3d(x[0], x[1], x[2]) / n;
    for (const auto& x : set.table.position_nm)
      square += (Eigen::Vector3d(x[0], x[1], x[2]) - mean).squaredNorm() / n;
    return std::pair(mean, std::sqrt(square / 3));
  };
  const auto [mean, width] = moments(r.particles);
  const auto [noise_mean, noise_width] = moments(noise);
  const double error_nm = 4 * width / std::sqrt(static_cast<double>(noise.table.size()));
  EXPECT_LT((noise_mean - mean).norm(), std::sqrt(3.0) * error_nm);
  EXPECT_NEAR(noise_width, width, error_nm);
  // Pores are hollow (no site within 53 nm of the axis), noise is not.
  std::size_t near_axis = 0;
  for (const std::uint32_t row : noise.particles[0].rows) {
    const auto& x = noise.table.position_nm[row];
    near_axis += std::hypot(x[0], x[1], x[2]) < 40 ? 1u : 0u;
  }
  EXPECT_GT(near_axis, noise.particles[0].rows.size() / 10);
}

TEST(ResolutionReport, IsSupportedOnlyWhereNoiseResolvesLess) {
  ResolutionReport report;
  EXPECT_FALSE(report.supported());
  report.data.resolution.period_nm = 10;
  EXPECT_TRUE(report.supported());  // noise resolves nothing
  report.noise.resolution.period_nm = 40;
  EXPECT_TRUE(report.supported());
  report.noise.resolution.period_nm = 9;
  EXPECT_FALSE(report.supported());
}

}  // namespace
}  // namespace polar
