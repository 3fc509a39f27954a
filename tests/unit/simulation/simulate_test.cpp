#include "polar/simulation/simulate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/simulation/cramer_rao.hpp"

namespace polar {
namespace {

// Every rotation of the group maps every site onto a site.
void expect_invariant(const Structure& s) {
  for (const Eigen::Matrix3d& g : symmetry_rotations(s.symmetry))
    for (Eigen::Index k = 0; k < s.site_nm.cols(); ++k) {
      const Eigen::Vector3d moved = g * s.site_nm.col(k);
      const double nearest = (s.site_nm.colwise() - moved).colwise().norm().minCoeff();
      EXPECT_LT(nearest, 1e-9) << s.name << " site " << k;
    }
}

TEST(Structure, SymmetryIsWhatItSays) {
  for (const char* kind : {"nuclear_pore", "centriole", "tetrahedron", "cube", "ring"}) {
    StructureOptions options;
    options.kind = kind;
    expect_invariant(make_structure(options));
  }
}

TEST(Structure, SizesOfTheKinds) {
  const auto sites = [](const char* kind) {
    StructureOptions options;
    options.kind = kind;
    return make_structure(options).site_nm.cols();
  };
  EXPECT_EQ(sites("nuclear_pore"), 32);
  EXPECT_EQ(sites("centriole"), 9 * 3 * 21);
  EXPECT_EQ(sites("tetrahedron"), 4);
  EXPECT_EQ(sites("cube"), 8);
  EXPECT_EQ(sites("ring"), 8);
}

SimulationOptions exact() {
  SimulationOptions o;
  o.particles = 20;
  o.labelling_efficiency = 1;
  o.label_size_nm = 0;
  o.sigma_xy_nm = {1e-6, 1e-6};
  o.field_spacing_nm = 500;
  o.cramer_rao = false;
  return o;
}

TEST(Simulate, TruePoseMapsTheTableOntoTheSites) {
  const Structure pore = make_structure({});
  const Simulation s = simulate(pore, exact());
  ASSERT_EQ(s.particle.size(), 20u);
  for (std::size_t row = 0; row < s.table.size(); ++row) {
    const auto& x = s.table.position_nm[row];
    const Eigen::Vector3d at =
        s.particle[static_cast<std::size_t>(s.table.particle[row])].structure_from_view *
        Eigen::Vector3d(x[0], x[1], x[2]);
    EXPECT_LT((pore.site_nm.colwise() - at).colwise().norm().minCoeff(), 1e-4);
  }
}

TEST(Simulate, SameBitsForAnyNumberOfThreads) {
  SimulationOptions o;
  o.particles = 30;
  o.outlier_fraction = 0.2;
  o.outliers = "strands";
  o.visibility = {0.5, 1};
  const Structure pore = make_structure({});
  const ThreadLimit one(1);
  const Simulation a = simulate(pore, o);
  const ThreadLimit two(2);
  const Simulation b = simulate(pore, o);
  ASSERT_EQ(a.table.position_nm, b.table.position_nm);
  for (std::size_t i = 0; i < a.particle.size(); ++i)
    EXPECT_EQ(a.particle[i].covariance, b.particle[i].covariance);
  o.seed = 2;
  EXPECT_NE(simulate(pore, o).table.position_nm, a.table.position_nm);
}

TEST(Simulate, NoiseHasTheStatedSize) {
  SimulationOptions o = exact();
  o.particles = 400;
  o.orientation = "identity";
  o.field_spacing_nm = 0;
  o.sigma_xy_nm = {4, 4};
  o.sigma_z_factor = {3, 3};
  Structure point{"point", Eigen::Matrix3Xd::Zero(3, 1), "none"};
  const Simulation s = simulate(point, o);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const auto& x : s.table.position_nm) squares += Eigen::Vector3d(x[0] * x[0], x[1] * x[1], x[2] * x[2]);
  squares /= static_cast<double>(s.table.size());
  const double relative = 5 * std::sqrt(2.0 / static_cast<double>(s.table.size()));  // five standard errors
  EXPECT_NEAR(squares.x() / 16, 1, relative);
  EXPECT_NEAR(squares.y() / 16, 1, relative);
  EXPECT_NEAR(squares.z() / 144, 1, relative);
}

TEST(Simulate, CropKeepsItsShareOnOneSide) {
  SimulationOptions o = exact();
  o.sampling = "points";
  o.points = {1000, 1000};
  o.visibility = {0.7, 0.7};
  const Simulation s = simulate(make_structure({"centriole"}), o);
  EXPECT_NEAR(static_cast<double>(s.table.size()), 20 * 700.0, 20 * 30.0);  // sites share planes
}

TEST(Simulate, OutliersAreTheirShare) {
  SimulationOptions o;
  o.outlier_fraction = 0.3;
  o.cramer_rao = false;
  const Simulation s = simulate(make_structure({}), o);
  double outliers = 0;
  for (const auto flag : s.is_outlier) outliers += flag;
  EXPECT_NEAR(outliers / static_cast<double>(s.table.size()), 0.3, 0.01);
}

TEST(Simulate, FaultsAreNamed) {
  SimulationOptions o;
  o.particles = 0;
  o.outliers = "strand";
  o.visibility = {0.9, 0.2};
  EXPECT_EQ(violations(o).size(), 3u);
}

// One site seen with isotropic covariance s^2: the information on its place is n / s^2 on each axis.
TEST(CramerRao, SingleSiteHasTheTextbookInformation) {
  StructureModel model;
  model.site_nm = Eigen::Vector3d(0, 0, 0);
  model.label_size_nm = 3;
  const smlm::Covariance c = {16, 0, 0, 16, 0, 16};
  const std::vector<smlm::Covariance> many(500, c);
  const Pose pose{so3_exp({0.3, -0.2, 1}), {5, 6, 7}};
  const auto information = fisher_information(model, pose, many, 40, 1, 0);
  const double expected = 500.0 / 25.0;
  const double relative = 5 * std::sqrt(2.0 / (500.0 * 40.0));  // five standard errors
  for (int axis = 3; axis < 6; ++axis) EXPECT_NEAR(information(axis, axis) / expected, 1, relative);
  EXPECT_LT((information.topLeftCorner<3, 3>().norm()), 1e-12);  // a point does not tell rotations
  EXPECT_FALSE(cramer_rao_bound(information, false).allFinite());
}

// Far-apart sites are told apart by their distance: information is that of known assignment,
// sum of J^T (S + l^2)^-1 J with J = [-[s]x, I].
TEST(CramerRao, WellSeparatedSitesReachKnownAssignment) {
  StructureModel model;
  model.site_nm = make_structure({"tetrahedron"}).site_nm * 10;
  const std::vector<smlm::Covariance> many(2000, smlm::Covariance{4, 0, 0, 4, 0, 9});
  const Pose pose{so3_exp({0.5, 0.1, -0.4}), {0, 0, 0}};
  const auto information = fisher_information(model, pose, many, 10, 1, 0);
  const Eigen::Matrix3d precision = Eigen::Vector3d(0.25, 0.25, 1.0 / 9).asDiagonal();
  Eigen::Matrix<double, 6, 6> expected = Eigen::Matrix<double, 6, 6>::Zero();
  for (Eigen::Index k = 0; k < 4; ++k) {
    Eigen::Matrix<double, 3, 6> j;
    j << -cross_matrix(model.site_nm.col(k)), Eigen::Matrix3d::Identity();
    expected += 500 * j.transpose() * pose.rotation * precision * pose.rotation.transpose() * j;
  }
  EXPECT_LT((information - expected).norm() / expected.norm(), 0.05);
}

TEST(CramerRao, PlanarParticlesHaveThreeFreedoms) {
  SimulationOptions o;
  o.planar = true;
  o.orientation = "in_plane";
  o.particles = 5;
  const Simulation s = simulate(make_structure({"ring"}), o);
  for (const SimulatedParticle& p : s.particle) {
    EXPECT_EQ(p.covariance(0, 0), 0);
    EXPECT_EQ(p.covariance(5, 5), 0);
    EXPECT_GT(p.covariance(2, 2), 0);
    EXPECT_LT(std::sqrt(p.covariance(2, 2)), 0.1);
    EXPECT_TRUE(p.covariance.allFinite());
  }
}

// Isotropic error of standard deviation s per axis: differences are chi distributed with three degrees of
// freedom and scale s sqrt(2); the median of chi_3 is 1.5382.
TEST(CramerRao, PairMedianOfIsotropicErrors) {
  const double s = 0.01;
  const std::vector<Eigen::Matrix<double, 6, 6>> bound(50, s * s * Eigen::Matrix<double, 6, 6>::Identity());
  const double expected = 1.5382 * s * std::sqrt(2.0) * kDegreesPerRadian;
  EXPECT_NEAR(pair_median_deg(bound, 1) / expected, 1, 0.03);
}

TEST(Simulate, CopiesDifferInRadiusAndHeight) {
  SimulationOptions o;
  o.particles = 400, o.orientation = "identity", o.cramer_rao = false, o.label_size_nm = 0;
  o.sigma_xy_nm = {1e-6, 1e-6};
  o.radius_std_nm = 4, o.height_std_nm = 6;
  const Simulation s = simulate(make_structure({"nuclear_pore"}), o);
  double radius = 0, height = 0;
  for (const SimulatedParticle& p : s.particle) {
    radius += p.radius_change_nm * p.radius_change_nm / o.particles;
    height += p.height_change_nm * p.height_change_nm / o.particles;
  }
  // A standard deviation from 400 draws is known to 3.5 %: three of these.
  EXPECT_NEAR(std::sqrt(radius), 4, 0.42);
  EXPECT_NEAR(std::sqrt(height), 6, 0.63);
  for (std::size_t i = 0; i < s.table.size(); ++i) {
    const auto& x = s.table.position_nm[i];
    const SimulatedParticle& p = s.particle[static_cast<std::size_t>(s.table.particle[i])];
    EXPECT_NEAR(std::hypot(x[0], x[1]), 53.5 + p.radius_change_nm, 1e-3);
    EXPECT_NEAR(std::abs(x[2]), 25 + p.height_change_nm / 2, 1e-3);
  }
}

}  // namespace
}  // namespace polar
