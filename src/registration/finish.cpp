#include "finish.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polar/fusion/calibration.hpp"
#include "polar/fusion/discretise.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/polish.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::size_t kDecisionLocalisations = 60000;  // over all views: enough to choose by, cheap to fit
constexpr int kFuseSweeps = 3;
constexpr int kMergedSweeps = 8;
constexpr double kMergeFactors[] = {1, 2, 4, 8};  // times the width of a centre
constexpr double kSmallestMerge = 0.02;           // particle radii
constexpr double kMergeTolerance =
    0.002;                          // held-out log density per localisation that fewer centres may cost
constexpr double kHopeless = 0.02;  // merging farther will not come back from this loss
constexpr int kPolishRounds = 2;
constexpr int kFewestLocalisations = 4;
constexpr double kMostOutliers = 0.8;
constexpr double kMostRotationStd = 0.5236;  // 30 degrees: such a pose says nothing

double typical_spread(const NoiseModel& n) { return std::max(n.lateral_extra, n.width); }

// Sites nearer than this are not told apart within one view.
double reach_of(const NoiseModel& n) { return 2 * typical_spread(n); }

std::vector<std::vector<float>> occupancy_of(const RoundState& state, const FusionData& evidence,
                                             const NoiseModel& noise) {
  return occupancy(state.mixture, evidence, state.pose, state.occupancy, reach_of(noise));
}

// A centre that dies stays dead: the number of sites is being found.
MaximisationOptions final_fusion() {
  MaximisationOptions em;
  em.free_weights = true;
  em.weakest_share = 0;
  return em;
}

void fuse(const Problem& problem, const NoiseModel& noise, const Subsets& subsets, int sweeps,
          RoundState& state) {
  FusionData data(problem.views, problem.axes, noise, subsets);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    data.set_visibility(occupancy_of(state, data, noise));
    maximise(state.mixture, data, state.pose, final_fusion());
    data.set_visibility(occupancy_of(state, data, noise));
    refine_poses(state.mixture, data, state.pose, 2);
  }
}

Subsets decision_subset(const Problem& problem) {
  return first_of(problem.fitted, std::max<std::size_t>(
                                      20, kDecisionLocalisations / std::max<std::size_t>(1, problem.size())));
}

// How much a view's own occupancy is believed: judged by localisations that did not estimate it. Infinite
// where views show the whole template. Returns the mean log density of the held-out localisations.
double choose_occupancy(const Problem& problem, const Subsets& few, const NoiseModel& noise,
                        RoundState& state) {
  const FusionData fitted(problem.views, problem.axes, noise, few);
  FusionData judged(problem.views, problem.axes, noise, problem.held_out);
  double best = -std::numeric_limits<double>::infinity();
  for (const double strength : {std::numeric_limits<double>::infinity(), 1.0, 0.3, 0.1, 0.03}) {
    judged.set_visibility(occupancy(state.mixture, fitted, state.pose, strength, reach_of(noise)));
    const double score =
        mean_per_localisation(mean_log_likelihood(state.mixture, judged, state.pose), problem.held_out);
    if (score > best) best = score, state.occupancy = strength;
  }
  return best;
}

NoiseModel calibrated(const Problem& problem, const Subsets& few, const NoiseModel& noise,
                      const RoundState& state) {
  std::vector<std::vector<float>> factors;
  if (std::isfinite(state.occupancy))
    factors = occupancy_of(state, FusionData(problem.views, problem.axes, noise, few), noise);
  return calibrate(problem.views, problem.axes, problem.held_out, state.mixture, state.pose, noise, factors)
      .noise;
}

}  // namespace

NoiseModel calibrate_and_fuse(const Problem& problem, int cycles, NoiseModel noise, RoundState& state) {
  const Subsets few = decision_subset(problem);
  for (int cycle = 0; cycle < cycles; ++cycle) {
    noise = calibrated(problem, few, noise, state);
    fuse(problem, noise, few, kFuseSweeps, state);
  }
  return noise;
}

NoiseModel choose_centres(const Problem& problem, const NoiseModel& noise, RoundState& state) {
  const Subsets few = decision_subset(problem);
  double best_score = choose_occupancy(problem, few, noise, state);
  RoundState best = state;
  NoiseModel best_noise = noise;
  for (const double factor : kMergeFactors) {
    RoundState trial = state;
    trial.mixture = merged(state.mixture, factor * std::max(typical_spread(noise), kSmallestMerge));
    if (trial.mixture.size() == best.mixture.size()) continue;
    NoiseModel trial_noise = noise;
    double score = 0;
    for (int cycle = 0; cycle < 2; ++cycle) {
      fuse(problem, trial_noise, few, kMergedSweeps / 2, trial);
      trial_noise = calibrated(problem, few, trial_noise, trial);
      score = choose_occupancy(problem, few, trial_noise, trial);
    }
    if (score < best_score - kHopeless) break;
    if (score < best_score - kMergeTolerance) continue;
    best_score = std::max(best_score, score);
    best = trial;
    best_noise = trial_noise;
  }
  state = best;
  return best_noise;
}

void polish_all(const Problem& problem, const NoiseModel& noise, RoundState& state, Registration& out) {
  FusionData data(problem.views, problem.axes, noise, problem.shuffled);
  std::vector<PolishedPose> polished;
  for (int round = 0; round < kPolishRounds; ++round) {
    data.set_visibility(occupancy_of(state, data, noise));
    polished = polish(state.mixture, data, state.pose);
    for (std::size_t i = 0; i < polished.size(); ++i) state.pose[i] = polished[i].template_from_view;
    if (round + 1 < kPolishRounds) maximise(state.mixture, data, state.pose, final_fusion());
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
      v.reason = "fewer than " + std::to_string(kFewestLocalisations) + " localisations";
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
