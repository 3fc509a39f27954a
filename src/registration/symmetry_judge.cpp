#include "symmetry_judge.hpp"

#include <algorithm>
#include <cmath>

#include "polar/fusion/occupancy.hpp"

namespace polar {

namespace {

constexpr int kSweeps = 3;               // of the fit of template and poses before it is judged
constexpr double kSmallestMerge = 0.02;  // particle radii

void move_to(const Pose& canonical_from_template, RoundState& state) {
  for (Pose& pose : state.pose) pose = canonical_from_template * pose;
  for (Eigen::Index k = 0; k < state.mixture.size(); ++k)
    state.mixture.centre.col(k) =
        (canonical_from_template * state.mixture.centre.col(k).cast<double>()).cast<float>();
}

}  // namespace

RoundState with_group(RoundState state, const NoiseModel& noise, const RotationGroup& group,
                      const Pose& canonical_from_template) {
  move_to(canonical_from_template, state);
  const auto before = static_cast<double>(state.mixture.size());
  state.group = group;
  state.mixture = symmetrised(state.mixture, group, std::max(kSmallestMerge, typical_spread(noise)));
  state.occupancy *= before / static_cast<double>(state.mixture.size());
  return state;
}

SymmetryJudge::SymmetryJudge(const Problem& problem, const NoiseModel& noise, const RoundState& state)
    : problem_(problem), noise_(noise), state_(state), jury_(jury(problem)), plain_(verdict(state)) {}

SymmetryGain SymmetryJudge::gain(const RotationGroup& group, const Pose& canonical_from_template) const {
  const std::vector<double> sum = verdict(with_group(state_, noise_, group, canonical_from_template));
  std::vector<double> count;
  double total = 0, localisations = 0, squares = 0;
  for (std::size_t k = 0; k < sum.size(); ++k) {
    count.push_back(static_cast<double>(jury_.held_out[static_cast<std::size_t>(jury_.which[k])].size()));
    total += sum[k] - plain_[k], localisations += count[k];
  }
  localisations = std::max(1.0, localisations);
  for (std::size_t k = 0; k < sum.size(); ++k) {
    const double d = sum[k] - plain_[k] - total / localisations * count[k];
    squares += d * d;
  }
  return {total / localisations, std::sqrt(squares) / localisations};
}

// A centre may stand for several of the template's, so weights are free.
std::vector<double> SymmetryJudge::verdict(RoundState state) const {
  MaximisationOptions em = final_fusion(state);
  em.free_weights = true, em.support = false;
  fuse(problem_, noise_, jury_, em, kSweeps, state);
  const std::vector<Pose> pose = poses_of(state, jury_.which);
  const FusionData fitted(problem_.views, problem_.axes, noise_, jury_.fitted, jury_.which);
  FusionData judged(problem_.views, problem_.axes, noise_, jury_.held_out, jury_.which);
  judged.set_visibility(occupancy(state.mixture, fitted, pose, state.occupancy, reach_of(noise_)));
  std::vector<double> sum = mean_log_likelihood(state.mixture, judged, pose);
  for (std::size_t k = 0; k < sum.size(); ++k)
    sum[k] *= static_cast<double>(jury_.held_out[static_cast<std::size_t>(jury_.which[k])].size());
  return sum;
}

}  // namespace polar
