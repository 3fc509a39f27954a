#include "polar/pipeline/simulate_run.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"
#include "smlm/particle_set.hpp"
#include "smlm/table_reader.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

class SimulateRun : public ::testing::TestWithParam<const char*> {
 protected:
  SimulateRun() {
    config_.directory = directory_.path("data");
    config_.format = GetParam();
    config_.simulation.particles = 5;
    config_.simulation.label_size_nm = 0;
    config_.simulation.sigma_xy_nm = {0.01, 0.01};
    config_.simulation.translation_nm = 300;
  }
  std::string table() const {
    return config_.directory + (config_.format == "csv" ? "/localisations.csv" : "/localisations.hdf5");
  }
  support::TemporaryDirectory directory_;
  SimulateConfig config_;
};

// Whatever the format, the truth maps the table that a reader sees onto the sites.
TEST_P(SimulateRun, TruthBelongsToTheTableAsItIsRead) {
  run_simulation(config_, false);
  const smlm::ParticleSet set = smlm::group_particles(smlm::read_table(table(), {}));
  const std::vector<PoseRow> truth = read_pose_table(config_.directory + "/poses.csv");
  const Structure pore = make_structure(config_.structure);
  ASSERT_EQ(set.particles.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(set.particles[i].name, truth[i].particle);
    EXPECT_EQ(set.particles[i].rows.size(), truth[i].n_localisations);
    for (const std::uint32_t row : set.particles[i].rows) {
      const auto& x = set.table.position_nm[row];
      const Eigen::Vector3d at = *truth[i].template_from_view * Eigen::Vector3d(x[0], x[1], x[2]);
      // Noise of 0.01 nm (0.03 axial), and Picasso's single precision.
      EXPECT_LT((pore.site_nm.colwise() - at).colwise().norm().minCoeff(), 0.2);
    }
  }
  EXPECT_NEAR(double(set.table.covariance_nm2[0][0]), 1e-4, 1e-6);
  EXPECT_TRUE(std::filesystem::exists(config_.directory + "/sites.csv"));
}

TEST_P(SimulateRun, TruthSummaryReadsBack) {
  run_simulation(config_, false);
  TruthSummary summary;
  ASSERT_TRUE(read_truth_summary(config_.directory + "/poses.csv", summary));
  EXPECT_EQ(summary.symmetry, "D8");
  EXPECT_GT(summary.cramer_rao_pair_median_deg, 0);
  EXPECT_FALSE(read_truth_summary(directory_.path("poses.csv"), summary));
}

TEST_P(SimulateRun, AnEarlierSimulationIsNotReplaced) {
  run_simulation(config_, false);
  EXPECT_THROW(run_simulation(config_, false), smlm::Error);
  EXPECT_NO_THROW(run_simulation(config_, true));
}

INSTANTIATE_TEST_SUITE_P(Formats, SimulateRun, ::testing::Values("csv", "picasso"),
                         [](const auto& format) { return std::string(format.param); });

}  // namespace
}  // namespace polar
