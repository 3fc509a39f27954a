#include "run_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "polar/core/median.hpp"
#include "polar/registration/tilt.hpp"
#include "polar/results/pose_table.hpp"
#include "symmetry_text.hpp"

namespace polar::pipeline {

namespace {

std::string winner(const Registration& g) {
  for (const StartReport& s : g.starts)
    if (s.won) return s.name;
  return "none";
}

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string agreement_text(double agreement) {
  if (!(agreement > 0)) return "";
  return format(", the best two pose %.0f %% of the particles alike", 100 * agreement);
}

std::string start_text(const Registration& g) {
  if (g.starts.empty()) return "the poses of registration.initial_poses";
  return winner(g) + " won of " + std::to_string(g.starts.size()) + agreement_text(g.agreement);
}

// NaN has no place in JSON.
nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json half_maps_json(const HalfMaps& h) {
  return {{"resolution_nm", number_or_null(h.resolution.period_nm)},
          {"at_nyquist", h.resolution.at_nyquist},
          {"particles", {h.first_particles, h.second_particles}},
          {"voxel_nm", h.voxel_nm},
          {"refused", h.refused},
          {"frequency_per_nm", h.shells.frequency_per_nm},
          {"correlation", h.shells.correlation}};
}

std::string period(const HalfMaps& h) {
  if (!std::isfinite(h.resolution.period_nm)) return "nothing";
  return format("%.2f nm", h.resolution.period_nm) + (h.resolution.at_nyquist ? " (two voxels)" : "");
}

std::string resolution_line(const ResolutionReport& r) {
  const bool compared = r.noise.first_particles > 0 && r.noise.second_particles > 0;
  return "resolution   " + period(r.data) + " between independent halves, " +
         (compared ? period(r.noise) + " in pure noise" : "no particle of pure noise has a pose") +
         (r.supported() ? "" : ": no structure is resolved");
}

// Medians over the accepted particles.
struct Precision {
  double rotation_std_deg = 0, translation_std_nm = 0;
};

Precision median_precision(const Results& r) {
  std::vector<double> rotation, translation;
  for (const PoseRow& row : pose_rows(r))
    if (row.accepted) {
      rotation.push_back(row.rotation_std_deg);
      translation.push_back(row.translation_std_nm);
    }
  return {upper_median(rotation), upper_median(translation)};
}

nlohmann::json calibration_json(const Results& r) {
  const Calibration& c = r.registration.calibration;
  const double scale_nm = r.normalisation.scale_nm;
  return {{"lateral_factor", c.lateral_factor},
          {"axial_factor", c.axial_factor},
          {"lateral_extra_nm", scale_nm * c.lateral_extra},
          {"axial_extra_nm", scale_nm * c.axial_extra}};
}

constexpr std::size_t kStrangersShown = 10;

std::string strangers_line(const std::vector<Stranger>& found) {
  std::string line = "unlike       ";
  for (std::size_t i = 0; i < std::min(found.size(), kStrangersShown); ++i)
    line += (i > 0 ? ", " : "") + found[i].particle + format(" (%+.1f)", found[i].deviation);
  if (found.size() > kStrangersShown)
    line += " and " + std::to_string(found.size() - kStrangersShown) + " more";
  return line + ": robust standard deviations of log_likelihood from the others";
}

// The prior's width, and what the poses say of it.
std::string tilt_line(const Results& r, double given_deg) {
  const std::optional<TiltSpread> tilt = tilt_spread(r.registration.view);
  return "tilt         " + format("%.1f deg about either axis", tilt ? tilt->std_deg : 0) +
         format(", %.1f were given as registration.tilt_deg", given_deg);
}

}  // namespace

std::vector<std::pair<std::size_t, std::string>> rejections(const Results& r) {
  std::map<std::string, std::size_t> count;
  for (const RegisteredView& v : r.registration.view)
    if (!v.accepted) ++count[v.reason];
  std::vector<std::pair<std::size_t, std::string>> sorted;
  sorted.reserve(count.size());
  for (const auto& [reason, n] : count) sorted.emplace_back(n, reason);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  return sorted;
}

std::vector<std::string> describe(const Results& r, double tilt_deg, const std::vector<Stranger>& unlike,
                                  const std::string& directory, double seconds) {
  const Registration& g = r.registration;
  const std::size_t n = r.particles.particles.size();
  std::vector<std::string> lines = {
      "structure    " + to_string(g.verdict) + ": " + g.verdict_reason,
      "particles    " + std::to_string(accepted_particles(r)) + " of " + std::to_string(n) + " accepted"};
  for (const auto& [count, reason] : rejections(r))
    lines.push_back("rejected     " + std::to_string(count) + ": " + reason);
  const Precision precision = median_precision(r);
  lines.push_back("precision    " + format("%.2f deg, ", precision.rotation_std_deg) +
                  format("%.2f nm", precision.translation_std_nm) +
                  " (median of the estimated standard deviations)");
  if (!unlike.empty()) lines.push_back(strangers_line(unlike));
  lines.push_back("start        " + start_text(g));
  lines.push_back("rounds       " + std::to_string(g.rounds) +
                  (g.converged ? ", converged: " : ", not converged: ") + g.stopped_because);
  if (g.symmetry) lines.push_back(symmetry_line(*g.symmetry, r.normalisation.scale_nm));
  if (g.other)
    lines.push_back("other        the average " +
                    (g.other->group == "C1" ? "without symmetry" : "with " + g.other->group) +
                    format(" predicts the labels of other views by %+.4f", g.other->gain) +
                    format(" +- %.4f nat a label", g.other->gain_std));
  if (tilt_deg > 0) lines.push_back(tilt_line(r, tilt_deg));
  if (r.resolution) lines.push_back(resolution_line(*r.resolution));
  lines.push_back("seconds      " + format("%.1f", seconds));
  lines.push_back("results      " + directory);
  return lines;
}

nlohmann::json summary_json(const Results& r, const std::vector<Stranger>& unlike,
                            const std::vector<std::string>& lines, const std::vector<std::string>& files,
                            double seconds) {
  const Registration& g = r.registration;
  nlohmann::json timings = nlohmann::json::array(), starts = nlohmann::json::array();
  for (const auto& t : g.timings)
    timings.push_back(
        {{"stage", t.stage}, {"seconds", t.seconds}, {"processor_seconds", t.processor_seconds}});
  for (const StartReport& s : g.starts)
    starts.push_back({{"name", s.name},
                      {"held_out_log_likelihood", s.held_out_log_likelihood},
                      {"gain", s.gain},
                      {"gain_std", s.gain_std},
                      {"won", s.won}});
  const Precision precision = median_precision(r);
  nlohmann::json summary = {{"program", r.provenance.program},
                            {"input_hash", r.provenance.input_hash},
                            {"seed", r.provenance.seed},
                            {"particles", r.particles.particles.size()},
                            {"accepted", accepted_particles(r)},
                            {"localisations", r.particles.table.size()},
                            {"planar", r.planar},
                            {"rounds", g.rounds},
                            {"verdict", to_string(g.verdict)},
                            {"verdict_reason", g.verdict_reason},
                            {"structure_gain", g.structure_gain},
                            {"structure_gain_std", g.structure_gain_std},
                            {"converged", g.converged},
                            {"stopped_because", g.stopped_because},
                            {"starts", starts},
                            {"starts_agreement", g.agreement},
                            {"precision",
                             {{"rotation_std_deg", number_or_null(precision.rotation_std_deg)},
                              {"translation_std_nm", number_or_null(precision.translation_std_nm)}}},
                            {"calibration", calibration_json(r)},
                            {"timings", timings},
                            {"warnings", g.warnings},
                            {"seconds", seconds},
                            {"files", files},
                            {"text", lines}};
  for (const Stranger& s : unlike)
    summary["unlike_the_others"].push_back({{"particle", s.particle}, {"deviation", s.deviation}});
  if (g.other)
    summary["other_average"] = {{"group", g.other->group},
                                {"held_out_gain", g.other->gain},
                                {"held_out_gain_std", g.other->gain_std}};
  if (g.symmetry) summary["symmetry"] = symmetry_json(*g.symmetry, r.normalisation.scale_nm);
  if (const std::optional<TiltSpread> tilt = tilt_spread(g.view); tilt && !r.planar)
    summary["tilt"] = {{"std_deg", tilt->std_deg}, {"particles", tilt->particles}};
  if (!g.weights_sha256.empty()) summary["weights_sha256"] = g.weights_sha256;
  if (r.resolution)
    summary["resolution"] = {{"halves", half_maps_json(r.resolution->data)},
                             {"noise", half_maps_json(r.resolution->noise)},
                             {"supported", r.resolution->supported()}};
  return summary;
}

}  // namespace polar::pipeline
