#include "polar/results/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "polar/core/parallel.hpp"
#include "polar/results/preview.hpp"
#include "polar/results/render.hpp"
#include "polar/results/result_file.hpp"
#include "polar/results/table_csv.hpp"
#include "polar/results/vtkhdf.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "support/fake_results.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

RenderOptions voxels_of(double nm, std::size_t most_per_axis) {
  RenderOptions options;
  options.voxel_nm = nm;
  options.most_voxels_per_axis = most_per_axis;
  return options;
}

class ResultsOfPores : public ::testing::Test {
 protected:
  ResultsOfPores() {
    SimulationOptions o;
    o.particles = 6;
    o.field_spacing_nm = 400;
    o.label_size_nm = 0;
    o.sigma_xy_nm = {2, 4};
    simulation_ = simulate(pore_, o);
    results_ = support::perfect_results(simulation_, pore_);
  }
  Structure pore_ = make_structure({});
  Simulation simulation_;
  Results results_;
  support::TemporaryDirectory directory_;
};

// The engine's rotations are products of many; what is written must be one to the last bits, because the
// inverse of a pose is taken by transposing, twenty micrometres away from the origin of a field of view.
TEST_F(ResultsOfPores, PosesAreRotationsHoweverTheyWereComposed) {
  results_.registration.view[2].template_from_view.rotation *= 1 + 2e-7;
  results_.normalisation.centre_nm[2] = {19000, 12000, 0};
  const Pose pose = template_from_table(results_, 2);
  const Eigen::Vector3d origin = pose.inverse() * Eigen::Vector3d::Zero();
  EXPECT_LT((pose * origin).norm(), 1e-9);
  EXPECT_LT((pose.rotation.transpose() * pose.rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST_F(ResultsOfPores, PosesActOnTheTableInNanometres) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Pose pose = template_from_table(results_, i);
    const Pose& truth = simulation_.particle[i].structure_from_view;
    EXPECT_LT((pose.rotation - truth.rotation).norm(), 1e-12);
    EXPECT_LT((pose.translation - truth.translation).norm(), 1e-9);
  }
  const auto c = pose_covariance_nm(results_, 0);
  EXPECT_NEAR(c(0, 0), 1e-4, 1e-15);
  EXPECT_NEAR(c(3, 3), 1.0, 1e-12);  // (0.01 x 100 nm)^2
  const std::vector<PoseRow> rows = pose_rows(results_);
  EXPECT_TRUE(rows[0].template_from_view);
  EXPECT_FALSE(rows[1].template_from_view);
  EXPECT_EQ(rows[1].reason, "made up, to test");
  EXPECT_NEAR(rows[0].translation_std_nm, std::sqrt(3.0), 1e-12);
}

TEST_F(ResultsOfPores, SuperparticleLiesOnTheSitesWithRotatedCovariances) {
  const smlm::LocalisationTable t = superparticle(results_);
  EXPECT_EQ(t.size(), simulation_.table.size() - results_.particles.particles[1].rows.size());
  double chi2 = 0;  // every localisation against its nearest site, by its own covariance
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Eigen::Vector3d x(t.position_nm[i][0], t.position_nm[i][1], t.position_nm[i][2]);
    const auto& c = t.covariance_nm2[i];
    Eigen::Matrix3d m;
    m << double(c[0]), double(c[1]), double(c[2]), double(c[1]), double(c[3]), double(c[4]), double(c[2]),
        double(c[4]), double(c[5]);
    double least = 1e300;
    for (Eigen::Index k = 0; k < pore_.site_nm.cols(); ++k) {
      const Eigen::Vector3d d = x - pore_.site_nm.col(k);
      least = std::min(least, d.dot(m.inverse() * d));
    }
    chi2 += least / static_cast<double>(t.size());
  }
  EXPECT_GT(chi2, 1.5);  // below 3, because the nearest site need not be the true one
  EXPECT_LT(chi2, 3.2);
  EXPECT_EQ(t.extra.size(), simulation_.table.extra.size());
  EXPECT_EQ(t.source_row.front(), simulation_.table.source_row.front());
}

TEST_F(ResultsOfPores, RecordReadsBack) {
  const smlm::LocalisationTable t = superparticle(results_);
  write_result_file(directory_.path("results.h5"), results_, t);
  const ResultRecord record = read_result_file(directory_.path("results.h5"));
  EXPECT_EQ(record.superparticle.position_nm, t.position_nm);
  EXPECT_EQ(record.superparticle.covariance_nm2, t.covariance_nm2);
  EXPECT_EQ(record.superparticle.particle, t.particle);
  EXPECT_EQ(record.superparticle.source_row, t.source_row);
  EXPECT_EQ(record.superparticle.extra[1].name, "intensity");
  EXPECT_EQ(record.superparticle.extra[1].values, t.extra[1].values);
  EXPECT_EQ(record.configuration, results_.provenance.configuration);
  EXPECT_LT((record.sites.centre_nm - pore_.site_nm).norm(), 1e-9);
  EXPECT_EQ(format_table_csv(record.superparticle), format_table_csv(t));
  const auto h5 = smlm::h5::File::open(directory_.path("results.h5"));
  const auto rotation = h5.read<double>("/poses/rotation");
  EXPECT_TRUE(std::isnan(rotation[9]));  // the rejected particle
  EXPECT_FALSE(std::isnan(rotation[0]));
  EXPECT_EQ(h5.read_string_attribute("/poses/translation", "unit"), "nm");
  EXPECT_EQ(h5.read<double>("/run/timings/seconds"), std::vector<double>{1.25});
  EXPECT_EQ(h5.read<double>("/run/timings/processor_seconds"), std::vector<double>{2.5});
}

TEST_F(ResultsOfPores, OtherFilesAreNoRecords) {
  write_points_vtkhdf(directory_.path("a.hdf"), superparticle(results_));
  EXPECT_THROW(read_result_file(directory_.path("a.hdf")), smlm::Error);
  EXPECT_THROW(read_result_file(directory_.path("none.h5")), smlm::Error);
}

TEST_F(ResultsOfPores, NothingAcceptedStillWrites) {
  for (RegisteredView& v : results_.registration.view) v.accepted = false;
  const smlm::LocalisationTable t = superparticle(results_);
  EXPECT_EQ(t.size(), 0u);
  write_result_file(directory_.path("results.h5"), results_, t);
  write_points_vtkhdf(directory_.path("aligned.hdf"), t);
  write_volume_vtkhdf(directory_.path("template.hdf"), render(t));
  write_preview_png(directory_.path("preview.png"), {{"", render(t)}});
  EXPECT_EQ(read_result_file(directory_.path("results.h5")).superparticle.size(), 0u);
}

TEST_F(ResultsOfPores, PointsFileHasVtkhdfLayout) {
  const smlm::LocalisationTable t = superparticle(results_);
  write_points_vtkhdf(directory_.path("aligned.hdf"), t);
  const auto h5 = smlm::h5::File::open(directory_.path("aligned.hdf"));
  EXPECT_EQ(h5.read_string_attribute("/VTKHDF", "Type"), "UnstructuredGrid");
  EXPECT_EQ(h5.info("/VTKHDF/Points").shape, (smlm::h5::Shape{t.size(), 3}));
  EXPECT_EQ(h5.read<std::int64_t>("/VTKHDF/Offsets").back(), static_cast<std::int64_t>(t.size()));
  for (const char* column : {"sigma_x_nm", "particle", "source_row", "frame", "intensity [photon]"})
    EXPECT_EQ(h5.info(std::string("/VTKHDF/PointData/") + column).shape.at(0), t.size()) << column;
}

TEST_F(ResultsOfPores, VolumeFileServesParaViewAndFiji) {
  const Volume v = render(superparticle(results_));
  write_volume_vtkhdf(directory_.path("template.hdf"), v);
  const auto h5 = smlm::h5::File::open(directory_.path("template.hdf"));
  EXPECT_EQ(h5.info("/VTKHDF/PointData/density").shape, (smlm::h5::Shape{v.size[2], v.size[1], v.size[0]}));
  const auto element = h5.read_attribute<float>("/VTKHDF/PointData/density", "element_size_um");
  ASSERT_EQ(element.size(), 3u);
  EXPECT_NEAR(double(element[0]), v.voxel_nm / 1000, 1e-7);
  EXPECT_EQ(h5.read_attribute<std::int64_t>("/VTKHDF", "WholeExtent")[1],
            static_cast<std::int64_t>(v.size[0]) - 1);
}

smlm::LocalisationTable single(const smlm::Covariance& c, bool planar) {
  smlm::LocalisationTable t;
  t.position_nm = {{10, -20, planar ? 0.0 : 5.0}};
  t.covariance_nm2 = {c};
  t.planar = planar;
  return t;
}

TEST(Render, GaussianHasItsMassPlaceAndSpread) {
  smlm::LocalisationTable t = single({25, 8, 0, 9, -6, 36}, false);
  // Two far points widen the box, so that the middle one is drawn whole.
  for (const double side : {-60.0, 60.0}) {
    t.position_nm.push_back({10 + side, -20 + side, 5 + side});
    t.covariance_nm2.push_back({1, 0, 0, 1, 0, 1});
  }
  const Volume v = render(t, voxels_of(1.0, 256));
  double mass = 0, xx = 0, xy = 0, yz = 0;
  for (std::size_t z = 0; z < v.size[2]; ++z)
    for (std::size_t y = 0; y < v.size[1]; ++y)
      for (std::size_t x = 0; x < v.size[0]; ++x) {
        const double dx = v.origin_nm[0] + v.voxel_nm * static_cast<double>(x) - 10;
        const double dy = v.origin_nm[1] + v.voxel_nm * static_cast<double>(y) + 20;
        const double dz = v.origin_nm[2] + v.voxel_nm * static_cast<double>(z) - 5;
        if (std::abs(dx) > 30 || std::abs(dy) > 30 || std::abs(dz) > 30) continue;
        const double share = double(v.at(x, y, z)) * std::pow(v.voxel_nm, 3);
        mass += share;
        xx += share * dx * dx;
        xy += share * dx * dy;
        yz += share * dy * dz;
      }
  EXPECT_NEAR(mass, 1, 3e-3);  // 1.1e-3 lies beyond four standard deviations
  EXPECT_NEAR(xx, 25, 0.3);
  EXPECT_NEAR(xy, 8, 0.15);
  EXPECT_NEAR(yz, -6, 0.15);
}

TEST(Render, PlanarIsOneSlicePerArea) {
  smlm::LocalisationTable t = single({25, 0, 0, 25, 0, 1}, true);
  t.position_nm.insert(t.position_nm.end(), {{-70, -100, 0}, {90, 60, 0}});
  t.covariance_nm2.insert(t.covariance_nm2.end(), {{1, 0, 0, 1, 0, 1}, {1, 0, 0, 1, 0, 1}});
  const Volume v = render(t, voxels_of(0.5, 1024));
  EXPECT_EQ(v.size[2], 1u);
  double mass = 0;
  float peak = 0;
  for (std::size_t y = 0; y < v.size[1]; ++y)
    for (std::size_t x = 0; x < v.size[0]; ++x) {
      const double dx = v.origin_nm[0] + v.voxel_nm * static_cast<double>(x) - 10;
      const double dy = v.origin_nm[1] + v.voxel_nm * static_cast<double>(y) + 20;
      if (std::hypot(dx, dy) > 40) continue;
      mass += double(v.at(x, y, 0)) * v.voxel_nm * v.voxel_nm;
      peak = std::max(peak, v.at(x, y, 0));
    }
  EXPECT_NEAR(mass, 1, 2e-3);
  EXPECT_NEAR(double(peak), 1 / (2 * 3.14159265358979 * 25), 1e-4);
}

TEST(Render, SameBitsForAnyNumberOfThreads) {
  SimulationOptions o;
  o.particles = 10;
  o.orientation = "identity";
  o.cramer_rao = false;
  const smlm::LocalisationTable t = simulate(make_structure({}), o).table;
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return render(t).density;
  };
  const auto one = with(1);
  EXPECT_EQ(with(2), one);
  EXPECT_EQ(with(4), one);
}

TEST(Render, StretchedCovariancesKeepTheirMass) {
  smlm::LocalisationTable t = single({2500, 2490, 0, 2500, 0, 1}, false);  // 71 nm by 3 nm, diagonal
  for (const double side : {-300.0, 300.0}) {
    t.position_nm.push_back({10 + side, -20 + side, 5 + side / 10});
    t.covariance_nm2.push_back({1, 0, 0, 1, 0, 1});
  }
  const Volume v = render(t, voxels_of(1.0, 1024));
  double mass = 0;
  for (const float d : v.density) mass += double(d);
  // Whole for the long one; the box ends two standard deviations outside the two others, on three axes each.
  EXPECT_NEAR(mass * std::pow(v.voxel_nm, 3), 1 + 2 * std::pow(0.977, 3), 0.05);
}

// Stated as 0.0007 nm across and 400 nm along an oblique axis: in floats no covariance any more.
TEST(Render, FlatCovariancesKeepTheirMassAndAreFinite) {
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Matrix3d m = 4.9e-7 * Eigen::Matrix3d::Identity() + 160000 * along * along.transpose();
  const auto f = [&](int a, int b) { return static_cast<float>(m(a, b)); };
  smlm::LocalisationTable t = single({f(0, 0), f(0, 1), f(0, 2), f(1, 1), f(1, 2), f(2, 2)}, false);
  for (const double side : {-2000.0, 2000.0}) {
    t.position_nm.push_back({10 + side, -20 + side, 5 + side});
    t.covariance_nm2.push_back({400, 0, 0, 400, 0, 400});
  }
  const Volume v = render(t, voxels_of(40.0, 1024));
  double mass = 0;
  for (const float d : v.density) {
    ASSERT_TRUE(std::isfinite(d) && d >= 0);
    mass += double(d);
  }
  // As above: the two others are cut by the box, 40 nm from their centres.
  EXPECT_NEAR(mass * std::pow(v.voxel_nm, 3), 1 + 2 * std::pow(0.977, 3), 0.1);
}

}  // namespace
}  // namespace polar
