#include "finish.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "jury.hpp"
#include "polar/fusion/discretise.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/polish.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr int kFuseSweeps = 3;
constexpr int kMergedSweeps = 8;
constexpr double kMergeFactors[] = {1, 2, 4, 8};  // times the width of a centre
constexpr double kSmallestMerge = 0.02;           // particle radii
constexpr double kMergeTolerance =
    0.002;                             // held-out log density per localisation that fewer centres may cost
constexpr double kHopeless = 0.02;     // merging farther will not come back from this loss
constexpr double kLeastOfSites = 0.3;  // occupancy strength: few sites are missing by chance, not by a crop
constexpr int kPolishRounds = 2, kPolishRoundsOfSites = 4;  // many free centres begin to fit noise
constexpr double kMostOutliers = 0.8;
constexpr double kMostRotationStd = 0.5236;  // 30 degrees: such a pose says nothing

// How much a view's own occupancy is believed: judged by localisations that did not estimate it. Infinite
// where views show the whole template. Returns the mean log density of the held-out localisations.
double choose_occupancy(const Problem& problem, const Jury& jury, const NoiseModel& noise,
                        RoundState& state) {
  const FusionData fitted(problem.views, problem.axes, noise, jury.fitted, jury.which);
  FusionData judged(problem.views, problem.axes, noise, jury.held_out, jury.which);
  const std::vector<Pose> pose = poses_of(state, jury.which);
  double best = -std::numeric_limits<double>::infinity();
  for (const double strength : {std::numeric_limits<double>::infinity(), 1.0, 0.3, 0.1, 0.03}) {
    if (state.sites && strength < kLeastOfSites) break;
    judged.set_visibility(occupancy(state.mixture, fitted, pose, strength, reach_of(noise)));
    const double score =
        mean_per_localisation(mean_log_likelihood(state.mixture, judged, pose), jury.which, jury.held_out);
    if (score > best) best = score, state.occupancy = strength;
  }
  return best;
}

CalibrationReport calibrated(const Problem& problem, const Jury& jury, const NoiseModel& noise,
                             const RoundState& state) {
  std::vector<std::vector<float>> factors;
  if (std::isfinite(state.occupancy)) {
    const FusionData fitted(problem.views, problem.axes, noise, jury.fitted, jury.which);
    auto own =
        occupancy(state.mixture, fitted, poses_of(state, jury.which), state.occupancy, reach_of(noise));
    factors.resize(problem.size());
    for (std::size_t k = 0; k < own.size(); ++k)
      factors[static_cast<std::size_t>(jury.which[k])] = std::move(own[k]);
  }
  return calibrate(problem.views, problem.axes, jury.held_out, state.mixture, state.pose, noise, factors);
}

}  // namespace

NoiseModel calibrate_and_fuse(const Problem& problem, int cycles, NoiseModel noise, RoundState& state) {
  const Jury few = jury(problem);
  double kept_score = -std::numeric_limits<double>::infinity();
  RoundState kept;
  for (int cycle = 0; cycle < cycles; ++cycle) {
    const CalibrationReport report = calibrated(problem, few, noise, state);
    if (report.log_likelihood < kept_score) {
      state = std::move(kept);
      return noise;
    }
    kept_score = report.log_likelihood;
    kept = state;
    noise = report.noise;
    fuse(problem, noise, few, final_fusion(state), kFuseSweeps, state);
  }
  return noise;
}

double held_out_score_of_parts(const Problem& problem, const NoiseModel& noise, RoundState state) {
  return choose_occupancy(problem, jury(problem), noise, state);
}

CalibrationReport choose_centres(const Problem& problem, const NoiseModel& noise, RoundState& state) {
  const Jury few = jury(problem);
  double best_score = choose_occupancy(problem, few, noise, state);
  RoundState best = state;
  NoiseModel best_noise = noise;
  for (const double factor : kMergeFactors) {
    RoundState trial = state;
    trial.sites = true;
    trial.occupancy = std::max(trial.occupancy, kLeastOfSites);
    const double distance = factor * std::max(typical_spread(noise), kSmallestMerge);
    trial.mixture = state.group.empty() ? merged(state.mixture, distance)
                                        : symmetrised(state.mixture, state.group, distance);
    if (trial.mixture.size() == best.mixture.size()) continue;
    NoiseModel trial_noise = noise;
    double score = 0;
    for (int cycle = 0; cycle < 2; ++cycle) {
      fuse(problem, trial_noise, few, final_fusion(trial), kMergedSweeps / 2, trial);
      trial_noise = calibrated(problem, few, trial_noise, trial).noise;
      score = choose_occupancy(problem, few, trial_noise, trial);
    }
    if (score < best_score - kHopeless) break;
    if (score < best_score - kMergeTolerance) continue;
    best_score = std::max(best_score, score);
    best = trial;
    best_noise = trial_noise;
  }
  state = best;
  return {best_noise, best_score};
}

void polish_all(const Problem& problem, const NoiseModel& noise, RoundState& state, Registration& out) {
  FusionData data(problem.views, problem.axes, noise, problem.shuffled);
  std::vector<PolishedPose> polished;
  const int rounds = state.sites ? kPolishRoundsOfSites : kPolishRounds;
  for (int round = 0; round < rounds; ++round) {
    data.set_visibility(occupancy(state.mixture, data, state.pose, state.occupancy, reach_of(noise)));
    polished = polish(state.mixture, data, state.pose);
    for (std::size_t i = 0; i < polished.size(); ++i) state.pose[i] = polished[i].template_from_view;
    if (round + 1 < rounds) maximise(state.mixture, data, state.pose, final_fusion(state));
  }
  out.view.resize(problem.size());
  for (std::size_t i = 0; i < problem.size(); ++i) {
    RegisteredView& v = out.view[i];
    const PolishedPose& p = polished[i];
    v.template_from_view = p.template_from_view;
    v.covariance = p.covariance;
    v.log_likelihood = p.log_likelihood;
    v.outlier_fraction = p.outlier_fraction;
    v.margin = i < state.margin.size() && std::isfinite(state.margin[i]) ? state.margin[i] : 0;
    v.visibility = shown_share(state.mixture, data.visibility(i));
    v.n_used = static_cast<int>(problem.shuffled[i].size());
    const double rotation_std = std::sqrt(std::max(0.0, v.covariance.topLeftCorner<3, 3>().trace()));
    v.reason.clear();
    if (v.n_used < kFewestLocalisations)
      v.reason = too_few_localisations();
    else if (!v.template_from_view.rotation.allFinite() || !v.template_from_view.translation.allFinite() ||
             !v.covariance.allFinite() || !std::isfinite(v.log_likelihood))
      v.reason = "its registration did not end in finite numbers";
    else if (state.structureless)
      v.reason = "the particles have no structure in common that explains localisations kept apart";
    else if (v.outlier_fraction > kMostOutliers)
      v.reason = "the template explains too few of its localisations";
    else if (!(rotation_std < kMostRotationStd))
      v.reason = "its rotation is not determined";
    v.accepted = v.reason.empty();
  }
  out.fused.centre = state.mixture.centre.cast<double>();
  out.fused.weight = state.mixture.weight.cast<double>();
  out.fused.width = noise.lateral_extra;
  out.fused.outlier_fraction = state.mixture.outlier_fraction;
  out.fused.outlier_density = state.mixture.outlier_density;
  out.calibration = {noise.lateral_factor, noise.axial_factor, noise.lateral_extra, noise.axial_extra};
}

}  // namespace polar
