#include "pipeline/initial_poses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "polar/core/so3.hpp"
#include "polar/results/pose_table.hpp"
#include "polar/results/results.hpp"
#include "smlm/error.hpp"
#include "support/temporary_directory.hpp"

namespace polar::pipeline {
namespace {

class InitialPoses : public ::testing::Test {
 protected:
  InitialPoses() {
    normalisation_.scale_nm = 50;
    for (int i = 0; i < 3; ++i) {
      PoseRow row;
      row.particle = std::to_string(i);
      row.accepted = i != 1;
      if (row.accepted) row.template_from_view = Pose{so3_exp({0.1 * i, 0.5, -0.2}), {10.0 * i, 20, 30}};
      rows_.push_back(row);
      particles_.push_back({row.particle, {}});
      normalisation_.centre_nm.emplace_back(100.0 * i, -40, 7);
    }
    write();
  }
  void write() { std::ofstream(directory_.path("poses.csv")) << format_pose_table(rows_); }
  support::TemporaryDirectory directory_;
  std::vector<PoseRow> rows_;
  std::vector<smlm::Particle> particles_;
  Normalisation normalisation_;
  Progress progress_;
};

TEST_F(InitialPoses, AreThoseThatComeOutAgain) {
  Results r;
  r.normalisation = normalisation_;
  for (const Pose& pose :
       initial_poses(directory_.path("poses.csv"), particles_, normalisation_, progress_)) {
    r.registration.view.emplace_back();
    r.registration.view.back().template_from_view = pose;
  }
  for (const std::size_t i : {0u, 2u}) {
    const Pose back = template_from_table(r, i);
    EXPECT_LT((back.translation - rows_[i].template_from_view->translation).norm(), 1e-9);
    EXPECT_LT(geodesic_angle(back.rotation, rows_[i].template_from_view->rotation), 1e-9);
  }
}

TEST_F(InitialPoses, OfOtherParticlesAreRefused) {
  rows_[0].particle = "another";
  write();
  try {
    initial_poses(directory_.path("poses.csv"), particles_, normalisation_, progress_);
    ADD_FAILURE();
  } catch (const smlm::Error& e) {
    EXPECT_EQ(e.exit_code(), 3);
    EXPECT_THAT(e.what(), ::testing::HasSubstr("has poses of 1 of the 3 particles"));
  }
}

}  // namespace
}  // namespace polar::pipeline
