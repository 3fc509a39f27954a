#include "polar/results/fourier_shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

constexpr std::size_t kEdge = 64;
constexpr double kVoxel_nm = 2;

Volume grid(bool planar) {
  Volume v;
  v.size = {kEdge, kEdge, planar ? 1 : kEdge};
  const double first_nm = -kVoxel_nm * (kEdge - 1) / 2.0;
  v.origin_nm = {first_nm, first_nm, planar ? 0 : first_nm};
  v.voxel_nm = kVoxel_nm;
  v.planar = planar;
  return v;
}

constexpr int kEmitters = 50;
// Share of the box's edge that emitters lie in: what is drawn must not reach the box's faces, whose cut both
// halves would have in common.
constexpr double kFilled = 0.4;

/// Localisations of kEmitters emitters, n each, scattered by and drawn with sigma_nm. `structure` places the
/// emitters, `half` draws the localisations.
Volume emitters(std::uint64_t structure, std::uint64_t half, int n, double sigma_nm, bool planar) {
  KeyedRandom place(7, structure, 1), noise(7, 2 * structure + half, 2);
  smlm::LocalisationTable t;
  t.planar = planar;
  t.particle_names = {"1"};
  const auto variance = static_cast<float>(sigma_nm * sigma_nm);
  for (int e = 0; e < kEmitters; ++e) {
    std::array<double, 3> site_nm{};
    for (std::size_t axis = 0; axis < (planar ? 2u : 3u); ++axis)
      site_nm[axis] = kFilled * kEdge * kVoxel_nm * (place.uniform() - 0.5);
    for (int i = 0; i < n; ++i) {
      std::array<double, 3> x = site_nm;
      for (std::size_t axis = 0; axis < (planar ? 2u : 3u); ++axis) x[axis] += sigma_nm * noise.normal();
      t.position_nm.push_back(x);
      t.covariance_nm2.push_back({variance, 0, 0, variance, 0, variance});
      t.particle.push_back(0);
    }
  }
  return render_into(grid(planar), t);
}

Volume white_noise(std::uint64_t item) {
  KeyedRandom random(8, item, 1);
  Volume v = grid(false);
  v.density.resize(kEdge * kEdge * kEdge);
  for (float& value : v.density) value = static_cast<float>(random.normal());
  return v;
}

// n localisations with sigma s about each emitter: per emitter a signal n^2 a and shot noise n (1 - a), with
// a = exp(-4 pi^2 s^2 q^2), whatever they are drawn with.
double expected(int n, double sigma_nm, double q) {
  const double a = std::exp(-std::pow(kTwoPi * sigma_nm * q, 2));
  return n * a / (n * a + 1 - a);
}
double expected_period_nm(int n, double sigma_nm) {
  const double odds = kResolutionThreshold / (1 - kResolutionThreshold);
  return kTwoPi * sigma_nm / std::sqrt(std::log((n + odds) / odds));
}

class Emitters : public ::testing::TestWithParam<bool> {};

TEST_P(Emitters, CorrelateAsTheirShotNoiseSays) {
  const bool planar = GetParam();
  const int pairs = planar ? 128 : 24;  // rings have fewer coefficients than shells
  constexpr int kLocalisations = 40;
  constexpr double kSigma_nm = 5;
  // Five standard errors, the emitters' own speckle counted as well as the shot noise.
  const double errors = 5 * std::sqrt(2.0);
  FourierShells mean;
  for (int pair = 0; pair < pairs; ++pair) {
    const auto key = static_cast<std::uint64_t>(pair);
    const FourierShells one = fourier_shells(emitters(key, 0, kLocalisations, kSigma_nm, planar),
                                             emitters(key, 1, kLocalisations, kSigma_nm, planar));
    mean.frequency_per_nm = one.frequency_per_nm;
    mean.coefficients = one.coefficients;
    mean.correlation.resize(one.correlation.size(), 0.0);
    for (std::size_t s = 0; s < one.correlation.size(); ++s)
      mean.correlation[s] += one.correlation[s] / pairs;
  }
  ASSERT_EQ(mean.correlation.size(), kEdge / 2);
  // m coefficients of a real density that fills part of the box are so many independent ones.
  const auto independent = [&](std::size_t s) {
    return std::max(
        1.0, pairs * std::pow(kFilled, planar ? 2 : 3) * static_cast<double>(mean.coefficients[s]) / 2);
  };
  for (std::size_t s = 0; s < mean.correlation.size(); ++s) {
    // Beyond this what is drawn (exp(-2 pi^2 s^2 q^2)) sinks into the rounding of a float.
    if (kTwoPi * kSigma_nm * mean.frequency_per_nm[s] > 5) break;
    const double wanted = expected(kLocalisations, kSigma_nm, mean.frequency_per_nm[s]);
    EXPECT_NEAR(mean.correlation[s], wanted, errors * (1 - wanted * wanted) / std::sqrt(independent(s)))
        << "shell " << s + 1;
  }
  // The period's error follows from the correlation's by its slope there, about -8 pi^2 s^2 q c (1 - c).
  const double period_nm = expected_period_nm(kLocalisations, kSigma_nm);
  const double slope =
      2 * std::pow(kTwoPi * kSigma_nm, 2) / period_nm * kResolutionThreshold * (1 - kResolutionThreshold);
  const auto shell = static_cast<std::size_t>(kEdge * kVoxel_nm / period_nm) - 1;
  const double error_nm = errors * period_nm * period_nm / slope / std::sqrt(independent(shell));
  const ShellResolution resolution = shell_resolution(mean);
  EXPECT_FALSE(resolution.at_nyquist);
  EXPECT_NEAR(resolution.period_nm, period_nm, error_nm);
  EXPECT_LT(error_nm, 0.2 * period_nm);  // a test that could not fail would prove nothing
}
INSTANTIATE_TEST_SUITE_P(Dimensions, Emitters, ::testing::Bool());

TEST(FourierShells, SharperLocalisationsResolveMoreInProportion) {
  const auto period = [](double sigma_nm) {
    double mean_nm = 0;  // of structures: the speckle of one moves its period by 6 %
    for (std::uint64_t structure = 0; structure < 8; ++structure)
      mean_nm += shell_resolution(fourier_shells(emitters(structure, 0, 40, sigma_nm, false),
                                                 emitters(structure, 1, 40, sigma_nm, false)))
                     .period_nm /
                 8;
    return mean_nm;
  };
  EXPECT_NEAR(period(4) / period(6), 2.0 / 3, 0.05);
}

TEST(FourierShells, PureNoiseResolvesNothing) {
  for (std::uint64_t pair = 0; pair < 5; ++pair) {
    const FourierShells shells = fourier_shells(white_noise(2 * pair), white_noise(2 * pair + 1));
    EXPECT_TRUE(std::isnan(shell_resolution(shells).period_nm));
    for (std::size_t s = 5; s < shells.correlation.size(); ++s)
      EXPECT_LT(std::abs(shells.correlation[s]),
                5 / std::sqrt(static_cast<double>(shells.coefficients[s]) / 2))
          << s;
  }
}

TEST(FourierShells, ADensityCorrelatesWithItselfToTheLastShell) {
  const Volume v = white_noise(0);
  const FourierShells shells = fourier_shells(v, v);
  for (const double c : shells.correlation) EXPECT_NEAR(c, 1, 1e-12);
  EXPECT_TRUE(shell_resolution(shells).at_nyquist);
  EXPECT_DOUBLE_EQ(shell_resolution(shells).period_nm, 2 * kVoxel_nm);
}

TEST(FourierShells, AnOppositeDensityCorrelatesNegatively) {
  Volume v = white_noise(0), opposite = v;
  for (float& value : opposite.density) value = -value;
  EXPECT_NEAR(fourier_shells(v, opposite).correlation[10], -1, 1e-12);
}

TEST(FourierShells, ResolutionIsInterpolatedBetweenShells) {
  FourierShells shells;
  shells.frequency_per_nm = {0.01, 0.02, 0.03, 0.04};
  shells.correlation = {1, 0.9, 0.643, -0.357};  // half way down between the last two
  EXPECT_NEAR(shell_resolution(shells, 0.143).period_nm, 1 / 0.035, 1e-9);
  shells.correlation = {1, 0.9, 0.1, 0.9};
  EXPECT_TRUE(std::isnan(shell_resolution(shells).period_nm));
}

TEST(FourierShells, TheSameBitsForAnyNumberOfThreads) {
  const Volume a = emitters(1, 0, 20, 4, false), b = emitters(1, 1, 20, 4, false);
  const std::vector<double> several = fourier_shells(a, b).correlation;
  const ThreadLimit limit(1);
  EXPECT_EQ(fourier_shells(a, b).correlation, several);
}

TEST(FourierShells, DifferentGridsAreRefused) {
  Volume a = white_noise(0), b = a;
  b.voxel_nm = 3;
  EXPECT_THROW(fourier_shells(a, b), smlm::Error);
  EXPECT_THROW(fourier_shells(grid(false), grid(false)), smlm::Error);  // no density at all
}

}  // namespace
}  // namespace polar
