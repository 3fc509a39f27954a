#include "assembly.hpp"

#include <algorithm>
#include <numeric>

#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/fusion/maximisation.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kPairTurnStage = 27;
constexpr std::size_t kMostViews = 50;   // pairs grow with the square of it
constexpr std::size_t kProbes = 4;       // views whose matches the winner is held against
constexpr std::size_t kProbedWith = 48;  // views each
constexpr std::size_t kSurest = 16;      // matches each that are believed
constexpr double kFewestEvidence = 1.5;  // of a match that says anything
// Two views with fewer, even localisations (median) have alignments by chance that beat the true one: pores
// with 72 do, halves of surfaces with 190 do not.
constexpr std::size_t kFewestOfAView = 150;
constexpr double kContradiction = 0.15;  // evidence that the winner's alignment must lack: twice its noise
constexpr double kTolerated = 0.03;      // share of contradicted matches: pairs err too
constexpr double kWidths[] = {0.15, 0.15, 0.12, 0.12, 0.09, 0.09};  // of the sweeps that relax an assembly
constexpr std::size_t kRelaxedLocalisations = 200;                  // of a view

Eigen::Matrix3f turn_of(const Problem& problem, std::size_t view) {
  return grid_turn(problem.planar(), KeyedRandom(problem.seed, view, kPairTurnStage));
}

}  // namespace

std::vector<Pose> spanning_poses(std::size_t views, std::vector<Joint> joints) {
  std::stable_sort(joints.begin(), joints.end(),
                   [](const Joint& a, const Joint& b) { return a.match.evidence > b.match.evidence; });
  std::vector<Pose> pose(views);  // group_from_view
  std::vector<std::size_t> group(views);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const Joint& j : joints) {  // J. B. Kruskal, Proceedings of the AMS 7, 1956
    const std::size_t stays = group[j.first], moves = group[j.second];
    if (stays == moves) continue;
    Pose stays_from_moves = pose[j.first] * j.match.first_from_second * pose[j.second].inverse();
    // Else what a match lacks of a rotation doubles each time that its group moves.
    stays_from_moves.rotation = nearest_rotation(stays_from_moves.rotation);
    for (std::size_t i = 0; i < views; ++i)
      if (group[i] == moves) pose[i] = stays_from_moves * pose[i], group[i] = stays;
  }
  const Pose rest = views > 0 ? pose[0].inverse() : Pose{};
  for (std::size_t i = 0; i < views; ++i) pose[i] = group[i] == group[0] ? rest * pose[i] : Pose{};
  return pose;
}

Assembly::Assembly(const Problem& problem)
    : problem_(problem),
      which_(some_views(problem, kMostViews)),
      pairs_(problem.views, problem.axes, problem.fitted, which_) {}

bool Assembly::contradicts(const std::vector<Pose>& template_from_view) const {
  const std::size_t n = which_.size();
  const auto pose = [&](std::size_t k) { return template_from_view[static_cast<std::size_t>(which_[k])]; };
  if (median_size(problem_.fitted, which_) < kFewestOfAView) return false;
  double asked = 0, denied = 0;
  for (std::size_t p = 0; p < std::min(n, kProbes); ++p) {
    const std::size_t first = p * n / kProbes;
    std::vector<std::size_t> others;
    for (std::size_t k = 1; k <= std::min(n - 1, kProbedWith); ++k) others.push_back((first + k) % n);
    const std::vector<Match> found = pairs_.matches(first, others, turn_of(problem_, first));
    std::vector<std::size_t> order(others.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return found[a].evidence > found[b].evidence; });
    for (std::size_t k = 0; k < std::min(kSurest, order.size()); ++k) {
      const Match& match = found[order[k]];
      if (match.evidence < kFewestEvidence) break;
      const std::size_t second = others[order[k]];
      const Match winner = pairs_.refined(first, second, pose(first).inverse() * pose(second));
      ++asked;
      denied += winner.evidence < match.evidence - kContradiction ? 1 : 0;
    }
  }
  return denied > kTolerated * asked;
}

RoundState Assembly::assembled(const RoundOptions& options, bool cut, Progress& progress) const {
  const std::size_t n = which_.size();
  std::vector<Joint> joints;
  const auto pairs = static_cast<int>(n * (n - 1) / 2);
  for (std::size_t first = 0; first < n && !progress.cancelled(); ++first) {
    std::vector<std::size_t> later(n - first - 1);
    std::iota(later.begin(), later.end(), first + 1);
    const std::vector<Match> found = pairs_.matches(first, later, turn_of(problem_, first));
    for (std::size_t k = 0; k < later.size(); ++k) joints.push_back({first, later[k], found[k]});
    progress.step("pairs of views", static_cast<int>(joints.size()), pairs);
  }
  std::vector<Pose> pose = spanning_poses(n, std::move(joints));

  RoundState state;
  state.far = true;
  state.cut = cut;
  state.crowded = !cut;  // a part that few views show would pass for a strand
  const Subsets few = first_of(problem_.fitted, kRelaxedLocalisations);
  state.mixture = scattered_mixture(problem_, few, which_, pose, centres_for(problem_), 1);
  state.mixture.outlier_fraction = first_outlier_fraction(state.crowded);
  for (const double width : kWidths) {  // errors add up along the tree: let all views settle
    NoiseModel noise;
    noise.planar = problem_.planar();
    noise.width = std::max(width, options.first_width);
    FusionData data(problem_.views, problem_.axes, noise, few, which_);
    if (cut) data.set_cut(problem_.reach, which_);
    MaximisationOptions em = fusion_options(state.crowded, noise.width);
    em.support = false;  // a part that few views show is no strand
    em.seed = problem_.seed;
    maximise(state.mixture, data, pose, em);
    maximise(state.mixture, data, pose, em);
    refine_poses(state.mixture, data, pose, 3);
  }
  state.pose.resize(problem_.size());
  for (std::size_t k = 0; k < n; ++k) state.pose[static_cast<std::size_t>(which_[k])] = pose[k];
  return state;
}

}  // namespace polar
