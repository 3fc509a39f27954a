// What a page draws and says, against the numbers of the record.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "polar/core/so3.hpp"
#include "report/curve.hpp"
#include "report/verdict.hpp"
#include "subject.hpp"

namespace polar::report {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::size_t kParticles = 12;  // one of them is rejected

class Sections : public ::testing::Test {
 protected:
  static const RunRecord& base() {
    static const RunRecord record = through_file(pores(kParticles));
    return record;
  }
  RunRecord record_ = base();
};

std::string notes(const Section& section) {
  std::string all;
  for (const std::string& n : section.notes) all += n + "\n";
  return all;
}

HalfMaps halves(std::vector<double> correlation) {
  HalfMaps h;
  h.first_particles = h.second_particles = 6;
  h.voxel_nm = 1;
  for (std::size_t i = 0; i < correlation.size(); ++i)
    h.shells.frequency_per_nm.push_back(0.5 * static_cast<double>(i + 1) /
                                        static_cast<double>(correlation.size()));
  h.shells.coefficients.assign(correlation.size(), 10);
  h.shells.correlation = std::move(correlation);
  h.resolution = shell_resolution(h.shells);
  return h;
}

TEST_F(Sections, VerdictFollowsTheEvidence) {
  EXPECT_EQ(verdict(record_).state, "found");
  EXPECT_THAT(verdict(record_).sentence, HasSubstr("11 of 12 particles fit one structure"));
  EXPECT_THAT(verdict(record_).warnings.back(), HasSubstr("nothing independent"));
  record_.agreement = 0.97;
  EXPECT_THAT(verdict(record_).sentence, HasSubstr("97 % of the particles alike"));
  record_.converged = false;
  EXPECT_EQ(verdict(record_).state, "ambiguous");
  record_.converged = true;
  record_.resolution = ResolutionReport{halves({1, 1, 1, 1, 0.1}), halves({1, 1, 1, 1, 0.9})};
  EXPECT_EQ(verdict(record_).state, "ambiguous");
  EXPECT_THAT(verdict(record_).sentence, HasSubstr("no more in common than pure noise"));
  record_.resolution.reset();
  for (std::size_t i = 0; i < 8; ++i)
    record_.poses[i].accepted = false, record_.poses[i].reason = "it is too small";
  EXPECT_EQ(verdict(record_).state, "ambiguous");
  EXPECT_THAT(verdict(record_).sentence, HasSubstr("Only 4 of 12 particles"));
  for (PoseRow& p : record_.poses) p.accepted = false, p.reason = "it is too small";
  EXPECT_EQ(verdict(record_).state, "none");
  EXPECT_THAT(verdict(record_).sentence, HasSubstr("it is too small (12)"));
  record_.verdict = "ambiguous", record_.verdict_sentence = "The run says so.";
  EXPECT_EQ(verdict(record_).sentence, "The run says so.");
}

TEST_F(Sections, ResolutionSaysWhereTheCurveFallsOrThatItNeverDoes) {
  EXPECT_THAT(figure(resolution_section(Subject(record_)), "fsc").svg, IsEmpty());
  EXPECT_THAT(figure(resolution_section(Subject(record_)), "fsc").caption,
              HasSubstr("output.resolution: halves"));
  record_.resolution = ResolutionReport{halves({1, 1, 1, 0.143, 0}), halves({0, 0, 0, 0, 0})};
  Section s = resolution_section(Subject(record_));
  EXPECT_THAT(notes(s),
              HasSubstr("The halves: falls below the threshold at a period of 2.50 nm"));  // 1 / 0.4
  EXPECT_THAT(notes(s), HasSubstr("The control on noise: already below the threshold"));
  EXPECT_THAT(figure(s, "fsc").svg, HasSubstr(">2.50 nm<"));
  EXPECT_THAT(figure(s, "half-maps").caption, HasSubstr("earlier version"));
  Projections first{2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}, second = first;
  record_.resolution->data.first_projections = first, record_.resolution->data.second_projections = second;
  s = resolution_section(Subject(record_));
  for (const char* id : {"half-1-xy", "half-2-xy", "half-1-xz", "half-2-xz"})
    EXPECT_THAT(figure(s, id).svg, HasSubstr("<image")) << id;
  EXPECT_THAT(figure(s, "half-1-xy").caption, HasSubstr("6 particles"));
  EXPECT_THAT(figure(s, "noise-half-maps").caption, HasSubstr("no pose"));
  record_.resolution->noise.first_projections = first, record_.resolution->noise.second_projections = second;
  record_.resolution->noise.refused = true;
  s = resolution_section(Subject(record_));
  EXPECT_THAT(figure(s, "noise-half-2-xy").svg, HasSubstr("<image"));
  EXPECT_THAT(figure(s, "fsc").caption, HasSubstr("refused"));
  record_.resolution->data = halves({1, 1, 1, 1, 1});
  s = resolution_section(Subject(record_));
  EXPECT_THAT(notes(s), HasSubstr("never falls below the threshold"));
  EXPECT_THAT(figure(s, "fsc").svg, Not(HasSubstr("2.50 nm")));
  EXPECT_THAT(figure(s, "resolution-curve").caption, HasSubstr("share the poses of this run"));
  record_.curve_particles = {3, 6, 12}, record_.curve_resolution_nm = {9, 7, 6};
  EXPECT_THAT(figure(resolution_section(Subject(record_)), "resolution-curve").caption,
              Not(HasSubstr("share the poses")));
  record_.resolution->noise = HalfMaps();
  EXPECT_THAT(notes(resolution_section(Subject(record_))),
              HasSubstr("no particle of pure noise got a pose that was accepted"));
}

TEST_F(Sections, MoreParticlesOfOneStructureResolveMore) {
  const RunRecord many = through_file(pores(65));
  const ResolutionCurve curve = curve_of_common_poses(Subject(many));
  ASSERT_EQ(curve.particles, (std::vector<double>{8, 16, 32, 64}));
  EXPECT_LT(curve.resolution_nm[3], curve.resolution_nm[0]);
  for (PoseRow& p : record_.poses) p.accepted = false;
  record_.result.superparticle = {};
  EXPECT_TRUE(curve_of_common_poses(Subject(record_)).particles.empty());
  EXPECT_THAT(figure(resolution_section(Subject(record_)), "resolution-curve").svg, IsEmpty());
}

TEST_F(Sections, DirectionsAreNamedForWhatTheyAre) {
  const auto named = [&](const std::function<Eigen::Vector3d(double, double)>& optical_axis) {
    RunRecord record = record_;
    record.poses.assign(400, record.poses[0]);
    record.fit.assign(400, record.fit[0]);
    const Subject frame(record_);  // the drawn frame must not decide
    for (std::size_t i = 0; i < 400; ++i) {
      const double u = (static_cast<double>(i) + 0.5) / 400,
                   v = std::fmod(static_cast<double>(i) * 0.618033988749895, 1);
      const Eigen::Vector3d z = optical_axis(u, v).normalized();
      Pose pose;
      pose.rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), z).toRotationMatrix();
      record.poses[i].template_from_view = pose;
    }
    return notes(directions_section(Subject(record)));
  };
  constexpr double kTurn = 6.283185307179586;
  EXPECT_THAT(named([](double u, double v) {
                const double z = 2 * u - 1, r = std::sqrt(1 - z * z);
                return Eigen::Vector3d(r * std::cos(kTurn * v), r * std::sin(kTurn * v), z);
              }),
              HasSubstr("are even"));
  EXPECT_THAT(named([](double, double v) {
                return Eigen::Vector3d(0.2 * std::cos(kTurn * v), 0.2 * std::sin(kTurn * v), 1);
              }),
              HasSubstr("gathered"));
  EXPECT_THAT(
      named([](double, double v) { return Eigen::Vector3d(std::cos(kTurn * v), std::sin(kTurn * v), 0.05); }),
      HasSubstr("a belt"));
}

TEST_F(Sections, ScoresDrawTheCutAndNameEveryRejection) {
  for (std::size_t i = 0; i < kParticles; ++i)
    record_.poses[i].log_likelihood = 1 + 0.01 * static_cast<double>(i);
  record_.poses[5].log_likelihood = 40;
  const Section s = scores_section(Subject(record_));
  EXPECT_THAT(figure(s, "log-likelihood").svg, HasSubstr(">unlike<"));
  EXPECT_THAT(figure(s, "log-likelihood").caption, HasSubstr("Beyond: 1 particle"));
  EXPECT_THAT(figure(s, "margin").caption, HasSubstr("have 0.5"));  // all alike: said, not drawn
  for (std::size_t i = 0; i < kParticles; ++i)
    record_.poses[i].margin = i < 4 ? 0 : 0.1 * static_cast<double>(i), record_.fit[i].posterior_share = 1;
  EXPECT_THAT(figure(scores_section(Subject(record_)), "margin").caption,
              HasSubstr("no second pose was found"));
  EXPECT_THAT(figure(s, "rejections").caption, HasSubstr("1: made up, to test"));
  ParticleScores refused;
  refused.log_likelihood = 0.5, refused.fit.posterior_share = 0.7;
  record_.refused = {refused, refused};
  for (ParticleFit& fit : record_.fit) fit.posterior_share = 0.99;
  record_.least_posterior_share = 0.9;
  const Figure share = figure(scores_section(Subject(record_)), "posterior-share");
  EXPECT_THAT(share.svg, HasSubstr(">0.900<"));
  EXPECT_THAT(share.svg, HasSubstr(">rejected<"));
  EXPECT_THAT(share.caption, HasSubstr("At least 0.900 is accepted (dashed): 2 particles beyond"));
  for (PoseRow& p : record_.poses) p.accepted = true;
  EXPECT_THAT(figure(scores_section(Subject(record_)), "rejections").svg, IsEmpty());
}

TEST_F(Sections, GalleryShowsBestWorstAndRejectedOrSaysWhyNot) {
  record_.poses[7].log_likelihood = 9, record_.poses[3].log_likelihood = -9;
  const Section s = gallery_section(Subject(record_));
  EXPECT_EQ(figure(s, "gallery-1").title, "Best: " + record_.poses[7].particle);
  EXPECT_THAT(figure(s, "gallery-1").svg, HasSubstr("class=\"outline\""));
  EXPECT_EQ(figure(s, "gallery-11").title, "Worst: " + record_.poses[3].particle);
  EXPECT_THAT(figure(s, "rejected-2").caption, HasSubstr("made up, to test"));
  EXPECT_THAT(figure(s, "rejected-2").svg, Not(HasSubstr("class=\"outline\"")));  // it has no pose
  RunRecord old = record_;
  old.rejected_particle.clear(), old.rejected_position.clear();
  EXPECT_THAT(figure(gallery_section(Subject(old)), "gallery-rejected").caption, HasSubstr("does not hold"));
  for (PoseRow& p : record_.poses) p.accepted = true;
  record_.rejected_particle.clear(), record_.rejected_position.clear();
  EXPECT_THAT(figure(gallery_section(Subject(record_)), "gallery-rejected").caption,
              HasSubstr("No particle was rejected"));
}

TEST_F(Sections, OccupancyIsThatOfTheRun) {
  EXPECT_THAT(figure(labelling_section(Subject(record_)), "occupancy").caption, HasSubstr("has neither"));
  LabellingRecord l;
  l.of = "symmetric units", l.efficiency = 0.545, l.low = 0.4, l.high = 0.7;
  l.occupancy = {1, 1.0 / 11};
  l.particles_with = {0, 10, 1}, l.labels_of = {0, 4, 8};
  record_.labelling = l;
  const Section s = labelling_section(Subject(record_));
  EXPECT_THAT(figure(s, "occupancy").svg, HasSubstr("100.0 %"));
  EXPECT_THAT(figure(s, "occupancy").svg, HasSubstr("9.1 % (2 % to 38 %)"));  // Wilson, 1 of 11
  EXPECT_THAT(notes(s), HasSubstr("54.5 % (40.0 % to 70.0 %), of 2 symmetric units"));
  EXPECT_THAT(figure(s, "labelled-a-particle").svg, HasSubstr("histogram of 11 values"));
  EXPECT_THAT(figure(s, "blinks").svg, HasSubstr("histogram of 12 values"));
  EXPECT_EQ(key_numbers(record_).back().value, "54.5 %");
}

TEST_F(Sections, ResidualsOfATruthfulTableAreNormal) {
  record_.result.sites.width_nm = 0;  // the simulated labels are points
  const Section s = uncertainties_section(Subject(record_));
  for (const char* id : {"residual-lateral", "residual-axial"}) {
    const std::string caption = figure(s, id).caption;
    const double found = std::stod(caption.substr(caption.find("deviation ") + 10));
    EXPECT_NEAR(found, 1, 0.12) << id;  // the nearest site is sometimes not the one
  }
  record_.result.render.lateral_factor = 3;  // as if the run had found three times the scatter
  const std::string caption = figure(uncertainties_section(Subject(record_)), "residual-lateral").caption;
  EXPECT_LT(std::stod(caption.substr(caption.find("deviation ") + 10)), 0.7);
}

TEST_F(Sections, RingsAreToldApartAlongTheAxis) {
  const Section s = rings_section(Subject(record_));
  EXPECT_THAT(notes(s), HasSubstr("2 layers"));
  ASSERT_EQ(s.tables.size(), 1u);
  for (const auto& row : s.tables[0].rows) EXPECT_NEAR(std::stod(row[4]), 50, 10);  // median radius, nm
  EXPECT_NEAR(std::stod(s.tables[0].rows[1][5]) - std::stod(s.tables[0].rows[0][5]), 50, 15);
}

TEST_F(Sections, StartsHaveTheirStandardErrorsWhereTheRecordDoes) {
  for (StartRecord& start : record_.starts) start.held_out_std = PoseRow::kNone;
  Section s = search_section(Subject(record_));
  EXPECT_THAT(figure(s, "starts").caption, HasSubstr("holds no standard errors"));
  EXPECT_THAT(figure(s, "rounds").svg, IsEmpty());
  EXPECT_THAT(figure(s, "time").svg, HasSubstr("1.25 s"));
  record_.starts[0].held_out_std = 0.25;
  record_.history = {{4.5, 10, 2, 1}, {1.5, 1, PoseRow::kNone, 1.5}};
  s = search_section(Subject(record_));
  EXPECT_THAT(figure(s, "starts").svg, HasSubstr("± 0.2500"));
  EXPECT_THAT(figure(s, "rounds").svg, Not(IsEmpty()));
  EXPECT_THAT(figure(s, "rounds-score").caption,
              HasSubstr("4.50 nm in the first round and of 1.50 nm in the last"));
}

TEST_F(Sections, ChannelsHaveAColourEach) {
  smlm::ExtraColumn channel;
  channel.name = "colour";
  channel.labels = {"Nup107", "WGA"};
  for (std::size_t i = 0; i < record_.result.superparticle.size(); ++i)
    channel.values.push_back(static_cast<double>(i % 2));
  record_.result.superparticle.extra.push_back(channel);
  EXPECT_THAT(figure(average_section(Subject(record_)), "projection-xy").svg,
              Not(HasSubstr("on-picture t0")));
  record_.channel_column = "colour";
  const std::string svg = figure(average_section(Subject(record_)), "projection-xy").svg;
  EXPECT_THAT(svg, HasSubstr("on-picture t0"));
  EXPECT_THAT(svg, HasSubstr(">WGA<"));
  record_.result.superparticle.extra.back().labels.clear();  // channels that are numbers
  EXPECT_THAT(figure(average_section(Subject(record_)), "projection-xy").svg, HasSubstr(">channel 1<"));
}

TEST_F(Sections, ToRunItAgainSaysWhatIsNotRecorded) {
  EXPECT_EQ(again_section(Subject(record_)).tables[0].rows[0][1], "not recorded");
  record_.command = "polar run a.yaml";
  record_.input_file = {"a.csv"}, record_.input_sha256 = {"abc"};
  const Section s = again_section(Subject(record_));
  EXPECT_EQ(s.tables[0].rows[0][1], "polar run a.yaml");
  EXPECT_EQ(s.tables[1].rows[0], (std::vector<std::string>{"a.csv", "abc"}));
}

}  // namespace
}  // namespace polar::report
