#include "rounds.hpp"

#include <algorithm>
#include <cmath>

#include "jury.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/search_again.hpp"
#include "states.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kTurnStage = 31;
constexpr double kLocalisationsPerCentre = 25;
constexpr double kFewestPerCentre = 12;  // fewer, and noise is registered as if it were a structure
constexpr int kFewestOfASurface = 320;
constexpr int kFewestCentres = 96, kMostCentres = 512;
constexpr std::size_t kSweepLocalisations = 300;  // of a view while the template is still moving
constexpr int kGivenSweeps = 8;
constexpr double kMisfits = 0.1;  // share of the views
constexpr const char* kUnderWay = "rounds";

// Template and poses of the views `which`; the others are as they were.
void sweep(const Problem& problem, const Subsets& few, const std::vector<int>& which, const NoiseModel& noise,
           int sweeps, int round, RoundState& state) {
  FusionData data(problem.views, problem.axes, noise, few, which);
  if (state.cut) data.set_cut(problem.reach, which);
  std::vector<Pose> pose = poses_of(state, which);
  for (int s = 0; s < sweeps; ++s) {
    MaximisationOptions em = fusion_options(state.crowded, noise.width);
    em.seed = problem.seed + static_cast<std::uint64_t>(100 * round + s);
    maximise(state.mixture, data, pose, em);
    if (s > 0) refine_poses(state.mixture, data, pose, 2);
  }
  for (std::size_t k = 0; k < which.size(); ++k) state.pose[static_cast<std::size_t>(which[k])] = pose[k];
}

// `far`: with shifts as large as the structure.
SearchAgainReport search(const Problem& problem, const SearchGrid& grid, const RoundOptions& options,
                         NoiseModel noise, const Subsets& subset, bool far, RoundState& state) {
  noise.width = std::max(noise.width, options.search_width);
  SearchAgainOptions search;
  search.basins = options.basins;
  search.group = state.group;
  if (state.cut) search.reach = &problem.reach;
  search.most_localisations = options.search_localisations;
  search.grid.translation =
      shifts_within(state.one_view ? options.stray_reach : 0, options.shift, problem.planar());
  search.grid.promising = options.promising;
  search.grid.step = options.step;
  if (far) {
    search.grid.translation = lattice_shifts(options.far_reach, options.far_spacing, problem.planar());
    search.grid.step = static_cast<float>(options.far_spacing / 2);
    search.coarse_localisations = options.far_coarse;
  }
  const Eigen::Matrix3f turn = grid_turn(
      problem.planar(), KeyedRandom(problem.seed, static_cast<std::uint64_t>(state.rounds), kTurnStage));
  return search_again(problem.views, problem.axes, subset, state.mixture, noise, grid, turn, search,
                      state.pose);
}

}  // namespace

int centres_for(const Problem& problem) {
  const int few = std::min(static_cast<int>(problem.localisations / kFewestPerCentre), kFewestOfASurface);
  const int usual = static_cast<int>(problem.localisations / kLocalisationsPerCentre);
  return std::clamp(std::max(few, usual), kFewestCentres, kMostCentres);
}

void fuse_anew(const Problem& problem, const RoundOptions& options, const std::vector<int>& which,
               RoundState& state) {
  const Subsets few = first_of(problem.fitted, kSweepLocalisations);
  state.mixture = scattered_mixture(problem, few, which, poses_of(state, which), centres_for(problem), 1);
  state.mixture.outlier_fraction = first_outlier_fraction(state.crowded);
  state.width = 0;
  state.held_out = -1e300;
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = options.first_width;
  sweep(problem, few, which, noise, kGivenSweeps, 0, state);
}

std::vector<std::size_t> search_all(const Problem& problem, const SearchGrid& grid,
                                    const RoundOptions& options, const NoiseModel& noise,
                                    const Subsets& subset, RoundState& state) {
  SearchAgainReport report = search(problem, grid, options, noise, subset, state.far, state);
  state.far = false;
  state.margin = std::move(report.margin);
  state.escaped = static_cast<int>(report.escaped.size());
  return std::move(report.escaped);
}

std::vector<std::size_t> search_misfits(const Problem& problem, const SearchGrid& grid,
                                        const RoundOptions& options, const NoiseModel& noise,
                                        RoundState& state) {
  const FusionData data(problem.views, problem.axes, noise, first_of(problem.shuffled, kSweepLocalisations));
  const std::vector<double> fit = mean_log_likelihood(state.mixture, data, state.pose);
  std::vector<int> order = problem.all;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return fit[static_cast<std::size_t>(a)] < fit[static_cast<std::size_t>(b)];
  });
  order.resize(static_cast<std::size_t>(std::ceil(kMisfits * static_cast<double>(problem.size()))));
  Subsets subset(problem.size());
  for (const int i : order)
    subset[static_cast<std::size_t>(i)] = problem.shuffled[static_cast<std::size_t>(i)];
  const SearchAgainReport report = search(problem, grid, options, noise, subset, true, state);
  for (const int i : order)
    state.margin[static_cast<std::size_t>(i)] = report.margin[static_cast<std::size_t>(i)];
  return report.escaped;
}

bool run_rounds(const Problem& problem, const SearchGrid& grid, const RoundOptions& options,
                Progress& progress, Checkpoint& checkpoint, RoundState& state) {
  const int total = 1 + static_cast<int>(std::ceil(std::log(options.last_width / options.first_width) /
                                                   std::log(options.narrowing)));
  const Subsets few = first_of(problem.fitted, kSweepLocalisations);
  NoiseModel noise;
  noise.planar = problem.planar();
  RoundsUnderWay now{0, true, std::move(state), {}};
  auto& [round, searching, at, best] = now;
  restore(checkpoint, kUnderWay, now);
  for (; round < total; ++round, ++at.rounds) {
    if (round > 0) keep(checkpoint, kUnderWay, now);
    if (progress.cancelled()) return false;
    noise.width = std::max(options.last_width, options.first_width * std::pow(options.narrowing, round));
    if (searching && round < options.most_searches) {
      search_all(problem, grid, options, noise, problem.fitted, at);
      searching = round == 0 || at.escaped > options.settled * static_cast<double>(problem.size());
    }
    if (round == 0 && !at.one_view) {
      const double outliers = at.mixture.outlier_fraction;
      at.mixture = scattered_mixture(problem, few, problem.all, at.pose, centres_for(problem), 1);
      at.mixture.outlier_fraction = std::max(outliers, first_outlier_fraction(at.crowded));
    }
    sweep(problem, few, problem.all, noise, options.sweeps, round, at);
    at.width = noise.width;
    at.held_out = held_out_score(problem, at.mixture, at.pose, noise, at.cut);
    if (at.held_out > best.held_out)
      best = at;
    else if (!searching)
      break;
    progress.step("registering", round + 1, total);
  }
  state = std::move(best.width > 0 ? best : at);
  checkpoint.drop(kUnderWay);
  return true;
}

}  // namespace polar
