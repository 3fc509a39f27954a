#include "polar/report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
  const Projections half{2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  results.resolution->data.first_projections = results.resolution->data.second_projections = half;
  results.resolution->noise.refused = true;
  LabelledPlaces labelled;
  labelled.labelling.of = "symmetric units", labelled.labelling.efficiency = 0.4;
  labelled.counts.occupancy = {0.4, 0.5}, labelled.counts.particles = {0, 3, 2},
  labelled.counts.labels = {0, 7};
  labelled.place_nm = Eigen::Matrix3Xd::Zero(3, 2);
  results.labelled = labelled;
  results.registration.history = {{0.09, 3, NAN, 1.5}};
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
  EXPECT_EQ(r.rejected_position[0],
            results.particles.table.position_nm[results.particles.particles[1].rows[0]]);
  EXPECT_EQ(r.command, "polar run 'my pores.yaml'");
  EXPECT_EQ(r.input_sha256[0], std::string(64, 'a'));
  EXPECT_EQ(r.starts.size(), 2u);
  EXPECT_EQ(r.starts[0].held_out_std, results.registration.starts[0].gain_std);
  ASSERT_TRUE(r.resolution.has_value());
  EXPECT_EQ(r.resolution->data.first_projections.value, half.value);
  EXPECT_EQ(r.resolution->data.second_projections.planes(), 3u);
  EXPECT_TRUE(r.resolution->noise.refused);
  ASSERT_TRUE(r.labelling.has_value());
  EXPECT_EQ(r.labelling->of, "symmetric units");
  EXPECT_EQ(r.labelling->efficiency, 0.4);
  EXPECT_EQ(r.labelling->particles_with, (std::vector<double>{0, 3, 2}));
  EXPECT_EQ(r.refused.size(), 1u);
  EXPECT_EQ(r.refused[0].log_likelihood, results.registration.view[1].log_likelihood);
  EXPECT_EQ(r.least_posterior_share, VerdictOptions().least_posterior_share);
  ASSERT_EQ(r.history.size(), 1u);
  EXPECT_EQ(r.history[0].width_nm, results.normalisation.scale_nm * 0.09);
  EXPECT_EQ(r.history[0].moved, 3);
  EXPECT_TRUE(std::isnan(r.history[0].escaped));
  EXPECT_EQ(r.history[0].held_out, 1.5);
}

// The smallest record that is one, with one particle, and with `more` in it.
RunRecord smallest(const std::function<void(smlm::h5::File&)>& more) {
  const support::TemporaryDirectory directory;
  smlm::h5::File f = smlm::h5::File::create(directory.path("results.h5"));
  f.write_string_attribute("/", "format", "polar-smlm result");
  f.write_attribute("/", "format_version", std::int32_t{1});
  f.write_strings("/poses/particle", {"a"});
  f.write_strings("/poses/reason", {""});
  f.write("/poses/accepted", std::vector<std::uint8_t>{1});
  for (const char* name : {"n_localisations", "n_used"})
    f.write(std::string("/poses/") + name, std::vector<std::uint64_t>{1});
  f.write("/poses/rotation", std::vector<double>{1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 3, 3});
  f.write("/poses/translation", std::vector<double>{0, 0, 0}, {1, 3});
  f.write("/poses/covariance", std::vector<double>(36, 0.01), {1, 6, 6});
  for (const char* name : {"log_likelihood", "margin"})
    f.write(std::string("/poses/") + name, std::vector<double>{1});
  f.write("/superparticle/position", std::vector<double>{1, 2, 3}, {1, 3});
  f.write("/superparticle/covariance", std::vector<float>{1, 0, 0, 1, 0, 1}, {1, 6});
  f.write("/superparticle/particle", std::vector<std::int64_t>{0});
  f.write("/superparticle/source_file", std::vector<std::uint32_t>{0});
  f.write("/superparticle/source_row", std::vector<std::uint64_t>{1});
  f.write_attribute("/superparticle", "planar", std::uint8_t{0});
  f.write_strings("/input/file", {"a.csv"});
  f.write_strings("/input/column_name", {});
  f.write_strings("/input/column_unit", {});
  f.make_group("/run/calibration");
  for (const char* name : {"lateral_factor", "axial_factor", "lateral_extra_nm", "axial_extra_nm"})
    f.write_attribute("/run/calibration", name, 1.0);
  f.write_strings("/run/warnings", {});
  for (const char* name : {"program", "configuration", "input_hash"})
    f.write_strings(std::string("/run/") + name, {"x"});
  f.write("/template/centre", std::vector<double>{1, 2, 3}, {1, 3});
  f.write("/template/weight", std::vector<double>{1});
  f.write_attribute("/template", "width_nm", 1.0);
  more(f);
  f.close();
  return read_run_record(directory.path("results.h5"));
}

TEST(ReportRecord, TakesWhatMayBeThereAndDoesWithout) {
  const RunRecord bare = smallest([](smlm::h5::File&) {});
  EXPECT_TRUE(bare.verdict.empty() && bare.starts.empty() && bare.history.empty() && !bare.symmetry &&
              !bare.resolution);
  EXPECT_THAT(report_page(bare, "bare"), HasSubstr("id=\"verdict\""));
  const RunRecord full = smallest([](smlm::h5::File& f) {
    f.write_string_attribute("/run", "verdict", "ambiguous");
    f.write_strings("/run/verdict_sentence", {"Two structures fit."});
    f.write_strings("/run/starts/name", {"random 1"});
    f.write("/run/starts/held_out_log_likelihood", std::vector<double>{1});
    f.write("/run/starts/gain_std", std::vector<double>{0.5});
    f.write("/run/history/moved", std::vector<double>{5, 1});
    f.write("/run/history/escaped", std::vector<double>{2});
    f.write("/run/history/held_out_log_likelihood", std::vector<double>{1, 2});
    f.write("/poses/posterior_share", std::vector<double>{0.75});
    f.write("/rejected/scores/log_likelihood", std::vector<double>{2});
    for (const char* name : {"margin", "rotation_std_deg", "translation_std_nm", "posterior_share",
                             "outlier_fraction", "visibility"})
      f.write(std::string("/rejected/scores/") + name, std::vector<double>{0.5});
    f.make_group("/resolution/halves");
    f.write("/resolution/curve/particles", std::vector<double>{1, 2});
    f.write("/resolution/curve/resolution_nm", std::vector<double>{9, 8});
  });
  EXPECT_EQ(full.verdict_sentence, "Two structures fit.");
  EXPECT_EQ(full.starts[0].held_out_std, 0.5);
  ASSERT_EQ(full.history.size(), 2u);
  EXPECT_EQ(full.history[0].escaped, 2);
  EXPECT_TRUE(std::isnan(full.history[1].escaped));
  EXPECT_EQ(full.fit[0].posterior_share, 0.75);
  ASSERT_EQ(full.refused.size(), 1u);
  EXPECT_EQ(full.refused[0].log_likelihood, 2);
  EXPECT_EQ(full.refused[0].fit.visibility, 0.5);
  EXPECT_EQ(full.curve_resolution_nm, (std::vector<double>{9, 8}));
  EXPECT_THAT(report_page(full, "full"), HasSubstr("Two structures fit."));
}

TEST(ReportRecord, DamageIsNamed) {
  const auto fault = [](const std::function<void(smlm::h5::File&)>& more) {
    try {
      smallest(more);
    } catch (const smlm::Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(fault([](smlm::h5::File& f) {
                f.write("/rejected/position", std::vector<double>{1, 2, 3}, {1, 3});
                f.write("/rejected/particle", std::vector<std::int64_t>{7});
              }),
              HasSubstr("/rejected: names a particle that is not there"));
  EXPECT_THAT(fault([](smlm::h5::File& f) { f.write("/rejected/particle", std::vector<std::int64_t>{0}); }),
              HasSubstr("/rejected: columns of different lengths"));
  EXPECT_THAT(fault([](smlm::h5::File& f) { f.write_strings("/run/timings/stage", {"a"}); }),
              HasSubstr("/run/timings"));
  EXPECT_THAT(fault([](smlm::h5::File& f) {
                f.write("/rejected/position", std::vector<double>{1, INFINITY, 3}, {1, 3});
                f.write("/rejected/particle", std::vector<std::int64_t>{0});
              }),
              HasSubstr("/rejected: a position that is none"));
  EXPECT_THAT(fault([](smlm::h5::File& f) { f.make_group("/symmetry"); }), HasSubstr("/symmetry"));
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
  for (const char* id :
       {"verdict", "average", "rings", "resolution", "directions", "scores", "gallery", "labelling",
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
