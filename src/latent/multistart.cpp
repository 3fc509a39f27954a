#include "multistart.hpp"

#include <algorithm>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kTurnStage = 54;
// Evaluations of one start: a few tell the basins apart, and only the best few are followed to their end.
constexpr int kFirstEvaluations = 3, kLastEvaluations = 7;
constexpr std::size_t kFollowed = 3;
constexpr int kAdamEvaluations = 1000;  // its plateau usually ends it earlier

bool less(const DescendedPose& a, const DescendedPose& b) { return a.loss < b.loss; }

}  // namespace

Multistart::Multistart(const Autoencoder& model, const LatentOptions& options, bool planar, std::size_t views,
                       const Progress& progress)
    : model_(model),
      options_(options),
      progress_(progress),
      planar_(planar),
      grid_(latent_grid(options, planar)),
      second_(views, DescendedPose{Pose(), -1, 0}) {}

std::vector<std::vector<Minimum>> Multistart::minima(const LatentViews& views, const Eigen::Matrix3Xf& points,
                                                     const PosedViews& state, int round, int most) const {
  const Eigen::Matrix3f turn =
      grid_turn(planar_, KeyedRandom(options_.seed, static_cast<std::uint64_t>(round), kTurnStage));
  return flames(model_, views, noise_classes(views, options_), grid_, turn, points, state.view_from_template,
                most);
}

std::vector<DescendedPose> Multistart::descended(const LatentView& view, const Eigen::Matrix3Xf& points,
                                                 const std::vector<Pose>& starts) const {
  std::vector<DescendedPose> found;
  found.reserve(starts.size());
  const auto descend = [&](const Pose& start, int evaluations) {
    return descend_pose(model_, view, planar_, points, start, options_, evaluations);
  };
  const bool paper = options_.optimizer == "adamw";
  for (const Pose& start : starts)
    found.push_back(descend(start, paper ? kAdamEvaluations : kFirstEvaluations));
  if (paper) return found;
  std::stable_sort(found.begin(), found.end(), less);
  for (std::size_t k = 0; k < std::min(kFollowed, found.size()); ++k)
    found[k] = descend(found[k].view_from_template, kLastEvaluations);
  return found;
}

std::vector<int> Multistart::improve(const LatentViews& views, const Eigen::Matrix3Xf& points, int round,
                                     bool present_too, const std::vector<int>& which, PosedViews& state) {
  const auto candidates = minima(views, points, state, round, options_.basins);
  std::vector<char> moved(which.size(), 0);
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    if (progress_.cancelled()) return;
    std::vector<Pose> starts;
    starts.reserve(candidates[i].size() + 1);
    for (const Minimum& m : candidates[i]) starts.push_back(m.view_from_template);
    if (present_too) starts.push_back(state.view_from_template[i]);
    moved[k] = update(i, descended(views.view[i], points, starts), state) ? 1 : 0;
  });
  std::vector<int> escaped;
  for (std::size_t k = 0; k < which.size(); ++k)
    if (moved[k]) escaped.push_back(which[k]);
  return escaped;
}

bool Multistart::update(std::size_t i, const std::vector<DescendedPose>& found, PosedViews& state) {
  const auto best = std::min_element(found.begin(), found.end(), less);
  if (best == found.end()) return false;
  const DescendedPose current{state.view_from_template[i], state.loss[i], 0};
  const double limit = options_.escape_deg * kRadiansPerDegree;
  const auto apart = [&](const DescendedPose& a, const DescendedPose& b) {
    return geodesic_angle(a.view_from_template.rotation, b.view_from_template.rotation) >= limit;
  };
  const bool better = best->loss <= current.loss;
  const bool escaped = better && apart(*best, current);  // s, eq. 15
  if (better) {                                          // u, eq. 14
    state.view_from_template[i] = best->view_from_template;
    state.loss[i] = best->loss;
  }
  const DescendedPose kept = better ? *best : current;
  second_[i] = {kept.view_from_template, -1, 0};
  const auto consider = [&](const DescendedPose& p) {
    if (apart(p, kept) && (second_[i].loss < 0 || p.loss < second_[i].loss)) second_[i] = p;
  };
  for (const DescendedPose& p : found) consider(p);
  consider(current);
  return escaped;
}

}  // namespace polar
