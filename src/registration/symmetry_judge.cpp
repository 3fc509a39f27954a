#include "symmetry_judge.hpp"

#include <algorithm>
#include <cmath>

#include "polar/fusion/occupancy.hpp"

namespace polar {

namespace {

constexpr int kSweeps = 3;               // of the fit of template and poses before it is judged
constexpr double kOfNearest = 0.45;      // below a half
constexpr double kSmallestMerge = 0.02;  // particle radii

// Images of one site err apart by what the template errs; two sites of a template that has the group are
// never nearer than its own nearest two.
double merging_distance(const Mixture& m, const NoiseModel& noise) {
  float least = INFINITY;
  for (Eigen::Index k = 0; k < m.size(); ++k)
    for (Eigen::Index l = 0; l < k; ++l)
      least = std::min(least, (m.centre.col(k) - m.centre.col(l)).squaredNorm());
  const double nearest = std::isfinite(least) ? std::sqrt(static_cast<double>(least)) : 0;
  return std::max({kSmallestMerge, typical_spread(noise), kOfNearest * nearest});
}

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
  state.mixture = symmetrised(state.mixture, group, merging_distance(state.mixture, noise));
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

// Weights stay what the template says, averaged over the group: sites are then alike on both sides, and none
// of the two may learn where registration has turned the bright ones.
std::vector<double> SymmetryJudge::verdict(RoundState state) const {
  MaximisationOptions em = final_fusion(state);
  em.keep_weights = true;
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
