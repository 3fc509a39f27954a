#include "jury.hpp"

#include <algorithm>

#include "polar/fusion/occupancy.hpp"

namespace polar {

namespace {
constexpr double kDecisionLocalisations = 60000;  // over all views: enough to choose by, cheap to fit
constexpr std::size_t kMostOfAView = 600;
}  // namespace

Jury jury(const Problem& problem) {
  const auto per_view = static_cast<double>(std::min<std::size_t>(
      kMostOfAView,
      static_cast<std::size_t>(problem.localisations) / std::max<std::size_t>(1, problem.size())));
  Jury jury;
  jury.which =
      some_views(problem, static_cast<std::size_t>(kDecisionLocalisations / std::max(1.0, per_view)) + 1);
  jury.fitted = first_of(problem.fitted, kMostOfAView);
  jury.held_out.resize(problem.size());
  for (const int i : jury.which)
    jury.held_out[static_cast<std::size_t>(i)] = problem.held_out[static_cast<std::size_t>(i)];
  return jury;
}

std::vector<Pose> poses_of(const RoundState& state, const std::vector<int>& which) {
  std::vector<Pose> pose;
  pose.reserve(which.size());
  for (const int i : which) pose.push_back(state.pose[static_cast<std::size_t>(i)]);
  return pose;
}

double typical_spread(const NoiseModel& n) { return std::max(n.lateral_extra, n.width); }

double reach_of(const NoiseModel& n) { return 2 * typical_spread(n); }

// A surface is described by centres of any weight. Sites weigh the same: that labels are missing is said by
// each view's occupancy, and weights of their own would let symmetric particles pile their bright sites on
// one. A centre that dies stays dead: the number of sites is being found.
MaximisationOptions final_fusion(const RoundState& state) {
  MaximisationOptions em;
  em.free_weights = !state.sites;
  em.support = !state.sites;
  em.weakest_share = 0;
  em.group = state.group;
  return em;
}

void fuse(const Problem& problem, const NoiseModel& noise, const Jury& jury, const MaximisationOptions& em,
          int sweeps, RoundState& state) {
  FusionData data(problem.views, problem.axes, noise, jury.fitted, jury.which);
  std::vector<Pose> pose = poses_of(state, jury.which);
  const auto set_occupancy = [&] {
    data.set_visibility(occupancy(state.mixture, data, pose, state.occupancy, reach_of(noise)));
  };
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    set_occupancy();
    maximise(state.mixture, data, pose, em);
    set_occupancy();
    refine_poses(state.mixture, data, pose, 2);
  }
  for (std::size_t k = 0; k < pose.size(); ++k) state.pose[static_cast<std::size_t>(jury.which[k])] = pose[k];
}

}  // namespace polar
