#include "polar/fitting/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/parallel.hpp"
#include "support/geometric_models.hpp"

namespace polar::fitting {
namespace {

constexpr double kBurstDistance = 3.4;  // the default

struct Pores {
  Simulation simulation;
  std::vector<FitData> data;
  Eigen::Matrix3Xd site_nm;
};

Pores pores(double radius_std_nm, double height_std_nm, std::uint64_t seed) {
  SimulationOptions o;
  o.particles = 50, o.seed = seed, o.blinks_mean = 5, o.cramer_rao = false, o.outlier_fraction = 0.03;
  o.radius_std_nm = radius_std_nm, o.height_std_nm = height_std_nm;
  const Structure structure = make_structure({"nuclear_pore"});
  Pores out{simulate(structure, o), {}, structure.site_nm};
  out.data = particles_of(testing::aligned_truth(out.simulation), kBurstDistance, 1);
  return out;
}

double correlation(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd x = a.array() - a.mean(), y = b.array() - b.mean();
  return (x * y).sum() / std::sqrt(x.square().sum() * y.square().sum());
}

ModesOptions quick() {
  ModesOptions o;
  o.modes = 2;
  o.draws = 7;
  return o;
}

TEST(Modes, RadiusAndHeightComeOutFirst) {
  const Pores p = pores(4, 5, 3);
  const ModesReport report = find_modes(p.data, p.site_nm, quick());
  const auto n = static_cast<Eigen::Index>(p.data.size());
  Eigen::VectorXd radius(n), height(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    radius[i] = p.simulation.particle[static_cast<std::size_t>(i)].radius_change_nm;
    height[i] = p.simulation.particle[static_cast<std::size_t>(i)].height_change_nm;
  }
  const Mode &first = report.position[0], &second = report.position[1];
  EXPECT_TRUE(first.above_noise);
  EXPECT_TRUE(second.above_noise);
  EXPECT_GT(first.radial, 0.9);
  EXPECT_GT(second.axial, 0.7);  // along z localisations are two to three times less certain
  // A chance correlation of 60 particles is 0.13; the limit itself is estimated.
  EXPECT_GT(std::abs(correlation(first.score, radius)), std::min(0.9, first.reliability - 0.1));
  EXPECT_GT(std::abs(correlation(second.score, height)), std::min(0.9, second.reliability - 0.1));
  EXPECT_GT(second.gain, 2 * second.gain_std);
  EXPECT_GT(first.share + second.share, 0.99);
  // Radius changes by sd 4 on every site.
  EXPECT_NEAR(std::sqrt(first.variance), 4, 1);
}

TEST(Modes, ARigidStructureHasNone) {
  const Pores p = pores(0, 0, 4);
  const ModesReport report = find_modes(p.data, p.site_nm, quick());
  for (const Mode& m : report.position) {
    EXPECT_FALSE(m.above_noise);
    EXPECT_LT(m.gain, 2 * m.gain_std);
  }
  for (const Mode& m : report.occupancy_mode) EXPECT_FALSE(m.above_noise);
}

// A crop takes sites of one side together.
TEST(Modes, CroppedParticlesShareTheirOccupancies) {
  SimulationOptions o;
  o.particles = 80, o.seed = 5, o.cramer_rao = false, o.visibility = {0.5, 0.8};
  const Structure structure = make_structure({"nuclear_pore"});
  const auto data = particles_of(testing::aligned_truth(simulate(structure, o)), kBurstDistance, 1);
  ModesOptions options = quick();
  options.modes = 2;
  options.draws = 5;
  const ModesReport report = find_modes(data, structure.site_nm, options);
  EXPECT_TRUE(report.occupancy_mode[0].above_noise);
  EXPECT_GT(report.occupancy_mode[0].reliability, 0.7);
}

TEST(Modes, SameBitsForAnyNumberOfThreads) {
  Pores p = pores(3, 0, 7);
  p.data.resize(16);
  ModesOptions o = quick();
  o.draws = 2;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return find_modes(p.data, p.site_nm, o);
  };
  const ModesReport one = with(1), two = with(2);
  EXPECT_EQ(one.position[0].field, two.position[0].field);
  EXPECT_EQ(one.position[0].control, two.position[0].control);
  EXPECT_EQ(one.position[0].score, two.position[0].score);
}

TEST(Landmarks, LieWhereLocalisationsAre) {
  const Pores p = pores(0, 0, 6);
  const Eigen::Matrix3Xd place = landmarks(superparticle_of(p.data), 16, 1);
  ASSERT_EQ(place.cols(), 16);
  for (Eigen::Index k = 0; k < place.cols(); ++k)
    EXPECT_LT((p.site_nm.colwise() - place.col(k)).colwise().norm().minCoeff(),
              30);  // a corner's pair and its noise
}

}  // namespace
}  // namespace polar::fitting
