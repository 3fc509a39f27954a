#include "polar/fusion/search_again.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "view_likelihood.hpp"

namespace polar {

namespace {

// Radians between neighbours of a grid of so many rotations over SO(3) or the circle.
double grid_spacing(double rotations, bool planar) {
  const double n = std::max(1.0, rotations);
  return planar ? kTwoPi / n : std::cbrt(8 * kPi * kPi / n);
}

struct Outcome {
  Pose pose;
  bool escaped = false;
  double margin = 0;
};

bool worse(const RefinedPose& a, const RefinedPose& b) { return a.log_likelihood < b.log_likelihood; }

std::vector<std::uint32_t> first_of(const std::vector<std::uint32_t>& list, int most) {
  const auto count = std::min(list.size(), static_cast<std::size_t>(most));
  return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(count)};
}

// Those that lie no farther below the best.
std::vector<RefinedPose> within(double doubt, const std::vector<RefinedPose>& candidates) {
  std::vector<RefinedPose> out;
  if (candidates.empty()) return out;
  const double best = std::max_element(candidates.begin(), candidates.end(), worse)->log_likelihood;
  std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(out),
               [&](const RefinedPose& p) { return p.log_likelihood >= best - doubt; });
  return out;
}

// The best few basins, climbed by look-ups, one pose a mode modulo the group; those that a look-up's error
// cannot save are left out.
std::vector<Pose> likely_modes(const DirectionVolumes& volumes, const SearchView& view,
                               const GridScores& scores, const SearchGrid& grid, const Eigen::Matrix3f& turn,
                               const SearchAgainOptions& options, bool planar) {
  const auto images = static_cast<int>(std::max<std::size_t>(1, options.group.size()));
  const double spacing =
      grid_spacing(static_cast<double>(grid.rotation.size()) * images / grid.prior.share(), planar);
  std::vector<LookedUpPose> found;
  for (const Pose& b : basins(scores, grid, turn, options.basins * std::min(images, 2)))
    if (const LookedUpPose p = climbed(volumes, view, b, static_cast<float>(options.climb_turn * spacing),
                                       static_cast<float>(options.climb_shift), planar);
        grid.prior.allows(p.rotation, options.group))
      found.push_back(p);
  std::stable_sort(found.begin(), found.end(),
                   [](const LookedUpPose& a, const LookedUpPose& b) { return a.score > b.score; });
  std::vector<Pose> out;
  for (const LookedUpPose& p : found) {
    if (out.size() >= static_cast<std::size_t>(options.basins)) break;
    if (p.score < found.front().score - options.lookup_doubt) break;
    const Pose pose{p.rotation.cast<double>(), p.translation.cast<double>()};
    const bool known = std::any_of(out.begin(), out.end(), [&](const Pose& o) {
      return angle_modulo(options.group, pose.rotation, o.rotation) < options.same_mode_rad &&
             (!options.group.empty() || (pose.translation - o.translation).norm() < 2 * options.climb_shift);
    });
    if (!known) out.push_back(pose);
  }
  return out;
}

Outcome best_of(const std::vector<RefinedPose>& candidates, const RefinedPose& current,
                const SearchAgainOptions& options, std::size_t localisations) {
  const auto top = std::max_element(candidates.begin(), candidates.end(), worse);
  const bool better = top != candidates.end() && top->log_likelihood > current.log_likelihood;  // eq. 14
  const RefinedPose& best = better ? *top : current;
  Outcome out{best.view_from_template.inverse(), false, INFINITY};
  const auto angle = [&](const RefinedPose& p) {
    return angle_modulo(options.group, p.view_from_template.rotation.transpose(),
                        best.view_from_template.rotation.transpose());
  };
  out.escaped = angle(current) >= options.escape_rad &&  // eq. 15
                best.log_likelihood > current.log_likelihood + options.escape_gain;
  const auto consider = [&](const RefinedPose& p) {
    if (angle(p) < options.escape_rad) return;
    out.margin =
        std::min(out.margin, (best.log_likelihood - p.log_likelihood) / static_cast<double>(localisations));
  };
  for (const RefinedPose& p : candidates) consider(p);
  consider(current);
  return out;
}

}  // namespace

SearchAgainReport search_again(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                               const Subsets& subset, const Mixture& mixture, const NoiseModel& noise,
                               const SearchGrid& grid, const Eigen::Matrix3f& turn,
                               const SearchAgainOptions& options, std::vector<Pose>& poses) {
  const SigmaClasses classes = sigma_classes(views, axes, noise, options.sigma_classes);
  const DirectionVolumes volumes(mixture, classes, directions_for(classes, noise.planar), noise.planar);
  const BlockedMixture blocked(mixture);
  std::vector<Outcome> outcome(views.view.size());
  parallel_for(views.view.size(), [&](std::size_t i) {
    const std::vector<std::uint32_t> few = first_of(subset[i], options.most_localisations);
    outcome[i].pose = poses[i];
    if (few.empty()) return;
    ViewFrame frame(blocked);
    const auto uphill = [&](const KernelLocalisations& of, const Pose& start, int evaluations) {
      RefinedPose p = refine_pose(frame, of, start, blocked.background(), noise.planar, evaluations);
      const Eigen::Matrix3d template_from_view = p.view_from_template.rotation.transpose();
      if (!grid.prior.allows(template_from_view, options.group)) p.log_likelihood = -INFINITY;
      return p;
    };
    const SearchView looked = search_view(views.view[i], axes[i], noise, classes, few);
    const GridScores scores = score_grid(volumes, looked, grid, turn, options.grid);
    const KernelLocalisations localisations = kernel_localisations(views.view[i], axes[i], noise, few);
    const auto refined = [&](const Pose& start) {
      return uphill(localisations, start.inverse(), options.evaluations);
    };
    std::vector<RefinedPose> candidates;
    for (const Pose& mode : likely_modes(volumes, looked, scores, grid, turn, options, noise.planar))
      candidates.push_back(refined(mode));
    const RefinedPose current = refined(poses[i]);
    outcome[i] = best_of(candidates, current, options, few.size());
    const bool clear = outcome[i].margin * static_cast<double>(few.size()) >= options.doubt;
    const auto many = first_of(subset[i], options.most_judging);
    if (clear || many.size() <= few.size()) return;
    const KernelLocalisations judging = kernel_localisations(views.view[i], axes[i], noise, many);
    const auto again = [&](const RefinedPose& p) {
      return uphill(judging, p.view_from_template, options.judging_evaluations);
    };
    std::vector<RefinedPose> rejudged;
    for (const RefinedPose& p : within(options.doubt, candidates)) rejudged.push_back(again(p));
    outcome[i] = best_of(rejudged, again(current), options, many.size());
  });
  SearchAgainReport report;
  for (std::size_t i = 0; i < outcome.size(); ++i) {
    poses[i] = outcome[i].pose;
    if (outcome[i].escaped) report.escaped.push_back(i);
    report.margin.push_back(outcome[i].margin);
  }
  return report;
}

}  // namespace polar
