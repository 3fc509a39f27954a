#include "rounds.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/rng.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/search_again.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kTurnStage = 31;
constexpr double kLocalisationsPerCentre = 25;
constexpr int kFewestCentres = 96, kMostCentres = 512;
constexpr std::size_t kSweepLocalisations = 300;  // of a view while the template is still moving
}  // namespace

int centres_for(const Problem& problem) {
  return std::clamp(static_cast<int>(problem.localisations / kLocalisationsPerCentre), kFewestCentres,
                    kMostCentres);
}

void search_all(const Problem& problem, const SearchGrid& grid, const RoundOptions& options, NoiseModel noise,
                RoundState& state) {
  noise.width = std::max(noise.width, options.search_width);
  SearchAgainOptions search;
  search.basins = options.basins;
  search.most_localisations = options.search_localisations;
  search.grid.translation = axis_shifts(options.shift, problem.planar());
  search.grid.promising = options.promising;
  search.grid.step = options.step;
  KeyedRandom turns(problem.seed, static_cast<std::uint64_t>(state.rounds), kTurnStage);
  const Eigen::Matrix3f turn = problem.planar() ? Eigen::Matrix3f(Eigen::Matrix3f::Identity())
                                                : Eigen::Matrix3f(turns.rotation().cast<float>());
  const SearchAgainReport report = search_again(problem.views, problem.axes, problem.shuffled, state.mixture,
                                                noise, grid, turn, search, state.pose);
  state.margin = report.margin;
  state.escaped = report.escaped;
}

void run_rounds(const Problem& problem, const SearchGrid& grid, const RoundOptions& options,
                Progress& progress, RoundState& state) {
  const int total = 1 + static_cast<int>(std::ceil(std::log(options.last_width / options.first_width) /
                                                   std::log(options.narrowing)));
  const Subsets few = first_of(problem.fitted, kSweepLocalisations);
  NoiseModel noise;
  noise.planar = problem.planar();
  bool searching = true;
  for (int round = 0; round < total && !progress.cancelled(); ++round, ++state.rounds) {
    noise.width = std::max(options.last_width, options.first_width * std::pow(options.narrowing, round));
    if (searching && round < options.most_searches) {
      search_all(problem, grid, options, noise, state);
      searching = round == 0 || state.escaped > options.settled * static_cast<double>(problem.size());
    }
    if (round == 0)
      state.mixture = scattered_mixture(problem, few, problem.all, state.pose, centres_for(problem), 1);
    const FusionData data(problem.views, problem.axes, noise, few);
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
      MaximisationOptions em;
      em.seed = problem.seed + static_cast<std::uint64_t>(100 * round + sweep);
      em.reseed_distance = 0.5 * noise.width;
      maximise(state.mixture, data, state.pose, em);
      if (sweep > 0) refine_poses(state.mixture, data, state.pose, 2);
    }
    progress.step("registering", round + 1, total);
  }
}

}  // namespace polar
