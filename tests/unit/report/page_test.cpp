#include "polar/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "polar/core/parallel.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "subject.hpp"

namespace polar::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kMostBytes = 5'000'000;

TEST(ReportRecord, HoldsWhatTheRunWrote) {
  Results results = pores(6);
  results.provenance.command = "polar run 'my pores.yaml'";
  results.provenance.input_file = {"/data/a.csv"}, results.provenance.input_sha256 = {std::string(64, 'a')};
  results.resolution = ResolutionReport();
  const RunRecord r = through_file(results);
  const std::vector<PoseRow> rows = pose_rows(results);
  ASSERT_EQ(r.poses.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(r.poses[i].particle, rows[i].particle);
    EXPECT_EQ(r.poses[i].reason, rows[i].reason);
    EXPECT_EQ(r.poses[i].n_localisations, rows[i].n_localisations);
    ASSERT_EQ(r.poses[i].template_from_view.has_value(), rows[i].accepted);
    if (!rows[i].accepted) continue;
    EXPECT_EQ(r.poses[i].template_from_view->rotation, rows[i].template_from_view->rotation);
    EXPECT_NEAR(r.poses[i].rotation_std_deg, rows[i].rotation_std_deg, 1e-12);
    EXPECT_NEAR(r.poses[i].translation_std_nm, rows[i].translation_std_nm, 1e-12);
  }
  EXPECT_EQ(accepted_particles(r), 5u);
  EXPECT_EQ(r.rejected_particle.size(), results.particles.particles[1].rows.size());
  EXPECT_EQ(r.rejected_position[0], results.particles.table.position_nm[results.particles.particles[1].rows[0]]);
  EXPECT_EQ(r.command, "polar run 'my pores.yaml'");
  EXPECT_EQ(r.input_sha256[0], std::string(64, 'a'));
  EXPECT_EQ(r.starts.size(), 2u);
  EXPECT_TRUE(std::isnan(r.starts[0].held_out_std));
  EXPECT_TRUE(r.resolution.has_value());
  EXPECT_TRUE(r.history.empty());
}

TEST(ReportRecord, RefusesWhatIsNoResult) {
  const support::TemporaryDirectory directory;
  EXPECT_THROW(read_run_record(directory.path("none.h5")), smlm::Error);
  smlm::h5::File file = smlm::h5::File::create(directory.path("other.h5"));
  file.write("/poses/particle", std::vector<double>{1});
  file.close();
  EXPECT_THROW(read_run_record(directory.path("other.h5")), smlm::Error);
}

TEST(ReportPage, HasEverySectionAndIsSmall) {
  const std::string page = report_page(through_file(pores(6)), "pores");
  EXPECT_LT(page.size(), kMostBytes);
  for (const char* id : {"verdict", "average", "rings", "resolution", "directions", "scores", "gallery", "labelling",
                         "uncertainties", "search", "again", "particles", "turntable", "configuration"})
    EXPECT_THAT(page, HasSubstr("id=\"" + std::string(id) + "\""));
  EXPECT_THAT(page, Not(HasSubstr("{{")));       // a template that was not filled
  EXPECT_THAT(page, Not(HasSubstr("http://")));  // nothing is fetched
  EXPECT_THAT(page, Not(HasSubstr("https://")));
}

TEST(ReportPage, NamesAreOnlyNames) {
  Results results = pores(6);
  results.particles.particles[0].name = "</script><script>alert(1)</script>";
  results.particles.particles[2].name = "a\xFF {{title}} & <b>";
  results.registration.view[1].reason = "<img src=x onerror=alert(1)>";
  const std::string page = report_page(through_file(results), "<i>pores</i>");
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("<i>")));
  EXPECT_THAT(page, HasSubstr("{{title}} &amp; &lt;b&gt;"));
}

TEST(ReportPage, IsTheSameForAnyNumberOfThreads) {
  const RunRecord record = through_file(pores(6));
  std::string one, four;
  {
    const ThreadLimit threads(1);
    one = report_page(record, "pores");
  }
  {
    const ThreadLimit threads(4);
    four = report_page(record, "pores");
  }
  EXPECT_EQ(one, four);
}

TEST(ReportPage, OfARunWithoutAPoseSaysSoEverywhere) {
  Results results = pores(6);
  for (RegisteredView& v : results.registration.view) v.accepted = false, v.reason = "it is noise";
  const std::string page = report_page(through_file(results), "noise");
  EXPECT_THAT(page, HasSubstr("No structure found"));
  EXPECT_THAT(page, HasSubstr("it is noise (6)"));
  EXPECT_THAT(page, HasSubstr("Rejected: "));
  EXPECT_THAT(page, Not(HasSubstr("nan")));
}

TEST(ReportPage, OfPlanarDataHasNoSphereAndNoTurntable) {
  SimulationOptions planar;
  planar.planar = true, planar.orientation = "in_plane";
  const std::string page = report_page(through_file(pores(6, planar)), "planar");
  EXPECT_THAT(page, HasSubstr("there is nothing to turn"));
  EXPECT_THAT(page, Not(HasSubstr("<canvas")));
  EXPECT_THAT(page, HasSubstr("id=\"projection-xy\" data-figure=\"present\""));
}

TEST(ReportPage, TakesTwentyThousandParticlesAndStaysSmall) {
  RunRecord record = through_file(pores(6));
  record.poses.resize(30000, record.poses[0]);
  record.fit.resize(30000, record.fit[0]);
  const std::string page = report_page(record, "many");
  EXPECT_LT(page.size(), kMostBytes);
  EXPECT_THAT(page, HasSubstr("10000 more particles are in poses.csv only"));
}

}  // namespace
}  // namespace polar::report
