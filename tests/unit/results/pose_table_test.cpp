#include "polar/results/pose_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "polar/core/so3.hpp"
#include "smlm/error.hpp"
#include "support/temporary_directory.hpp"

namespace polar {
namespace {

class PoseTable : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(directory_.path("poses.csv")) << text;
    return directory_.path("poses.csv");
  }
  void expect_fault(const std::string& text, const std::string& part) {
    try {
      read_pose_table(write(text));
      ADD_FAILURE() << "accepted: " << text;
    } catch (const smlm::Error& e) {
      EXPECT_EQ(e.exit_code(), 3);
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  }
  support::TemporaryDirectory directory_;
};

TEST_F(PoseTable, ReadsBackWhatItWrote) {
  PoseRow a;
  a.particle = "cell 1, pore \"7\"";
  a.n_localisations = 120;
  a.n_used = 118;
  a.accepted = true;
  a.template_from_view = Pose{so3_exp({2.9, -0.4, 0.3}), {1e4 / 3, -2.5, 1e-9}};
  a.rotation_std_deg = 0.1;
  a.translation_std_nm = 1.0 / 7;
  a.log_likelihood = -12.5;
  a.margin = 0.25;
  PoseRow b;
  b.particle = "x";
  b.reason = "too few localisations, 2";
  const std::vector<PoseRow> rows = read_pose_table(write(format_pose_table({a, b})));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].particle, a.particle);
  EXPECT_EQ(rows[0].n_used, 118u);
  EXPECT_TRUE(rows[0].accepted);
  ASSERT_TRUE(rows[0].template_from_view);
  EXPECT_LT((rows[0].template_from_view->rotation - a.template_from_view->rotation).norm(), 1e-14);
  EXPECT_EQ(rows[0].template_from_view->translation, a.template_from_view->translation);
  EXPECT_EQ(rows[0].translation_std_nm, a.translation_std_nm);
  EXPECT_EQ(rows[0].margin, 0.25);
  EXPECT_FALSE(rows[1].accepted);
  EXPECT_FALSE(rows[1].template_from_view);
  EXPECT_EQ(rows[1].reason, b.reason);
  EXPECT_TRUE(std::isnan(rows[1].margin));
}

TEST_F(PoseTable, HeaderIsThePromisedOne) {
  const std::string text = format_pose_table({});
  EXPECT_EQ(text,
            "particle,n_localisations,n_used,accepted,reason,qw,qx,qy,qz,tx_nm,ty_nm,tz_nm,"
            "rotation_std_deg,translation_std_nm,log_likelihood,margin\n");
}

TEST_F(PoseTable, FaultsNameFileAndLine) {
  const std::string header = "particle,qw,qx,qy,qz,tx_nm,ty_nm,tz_nm\n";
  expect_fault("particle,qw\n", "'qx' is missing");
  expect_fault(header + "a,1,0,0,0,0,0\n", "poses.csv:2");
  expect_fault(header + "a,1,0,0,0,0,0,1.5x\n", "'1.5x'");
  expect_fault(header + "a,1,0,0,0,,0,0\n", "incomplete pose");
  expect_fault(header + "a,2,0,0,0,0,0,0\n", "length 1");
  expect_fault("", "missing");
  expect_fault("particle,qw,qx,qy,qz,tx_nm,ty_nm,qw,tz_nm\na,1,0,0,0,0,0,0,0\n", "'qw' occurs twice");
  EXPECT_EQ(read_pose_table(write(header + "a,1,0,0,0,0,0,0\r\n")).size(), 1u);
}

}  // namespace
}  // namespace polar
