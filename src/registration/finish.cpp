#include "finish.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "polar/fusion/calibration.hpp"
#include "polar/fusion/discretise.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/polish.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::size_t kDecisionLocalisations = 60000;  // over all views: enough to choose by, cheap to fit
constexpr int kFuseSweeps = 3;
constexpr int kMergedSweeps = 8;
constexpr double kMergeTolerance =
    0.002;  // held-out log density per localisation that fewer centres may cost
constexpr int kPolishRounds = 2;
constexpr int kFewestLocalisations = 4;
constexpr double kMostOutliers = 0.8;
constexpr double kMostRotationStd = 0.5236;  // 30 degrees: such a pose says nothing

void fuse(const Problem& problem, const NoiseModel& noise, const Subsets& subsets, int sweeps, bool move,
          RoundState& state) {
  const FusionData data(problem.views, problem.axes, noise, subsets);
  MaximisationOptions em;
  em.free_weights = true;
  em.weakest_share = 0;  // a centre that dies stays dead: the number of sites is being found
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    maximise(state.mixture, data, state.pose, em);
    if (move) refine_poses(state.mixture, data, state.pose, 2);
  }
}

Subsets decision_subset(const Problem& problem) {
  return first_of(problem.fitted, std::max<std::size_t>(
                                      20, kDecisionLocalisations / std::max<std::size_t>(1, problem.size())));
}

double typical_spread(const NoiseModel& n) { return std::max(n.lateral_extra, n.width); }

}  // namespace

NoiseModel calibrate_and_fuse(const Problem& problem, int cycles, NoiseModel noise, RoundState& state) {
  const Subsets few = decision_subset(problem);
  for (int cycle = 0; cycle < cycles; ++cycle) {
    noise = calibrate(problem.views, problem.axes, problem.held_out, state.mixture, state.pose, noise).noise;
    fuse(problem, noise, few, kFuseSweeps, true, state);
  }
  return noise;
}

NoiseModel choose_centres(const Problem& problem, const NoiseModel& noise, RoundState& state) {
  double best_score = held_out_score(problem, state.mixture, state.pose, noise);
  RoundState best = state;
  NoiseModel best_noise = noise;
  const Subsets few = decision_subset(problem);
  for (const double factor : {1.0, 2.0, 4.0, 8.0}) {
    RoundState trial = state;
    trial.mixture = merged(state.mixture, factor * std::max(typical_spread(noise), 0.02));
    if (trial.mixture.size() == best.mixture.size()) continue;
    NoiseModel trial_noise = noise;
    for (int cycle = 0; cycle < 2; ++cycle) {
      fuse(problem, trial_noise, few, kMergedSweeps / 2, true, trial);
      trial_noise =
          calibrate(problem.views, problem.axes, problem.held_out, trial.mixture, trial.pose, trial_noise)
              .noise;
    }
    const double score = held_out_score(problem, trial.mixture, trial.pose, trial_noise);
    if (score < best_score - kMergeTolerance) continue;
    best_score = std::max(best_score, score);
    best = trial;
    best_noise = trial_noise;
  }
  state = best;
  return best_noise;
}

void polish_all(const Problem& problem, const NoiseModel& noise, RoundState& state, Registration& out) {
  const FusionData data(problem.views, problem.axes, noise, problem.shuffled);
  std::vector<PolishedPose> polished;
  for (int round = 0; round < kPolishRounds; ++round) {
    fuse(problem, noise, problem.shuffled, 1, false, state);
    polished = polish(state.mixture, data, state.pose);
    for (std::size_t i = 0; i < polished.size(); ++i) state.pose[i] = polished[i].template_from_view;
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
