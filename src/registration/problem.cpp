#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "evenness.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kShuffleStage = 20, kThinningStage = 25;
constexpr std::size_t kHeldOutShare = 5;  // one localisation in five judges
}  // namespace

Problem make_problem(const Views& views, std::uint64_t seed, bool thinned) {
  const std::size_t views_n = views.view.size();
  Problem problem{views, {}, {}, {}, {}, {}, seed, 0};
  problem.axes.resize(views_n), problem.shuffled.resize(views_n);
  problem.fitted.resize(views_n), problem.held_out.resize(views_n);
  parallel_for(views_n, [&](std::size_t i) {
    problem.axes[i] = uncertainty_axis(views.view[i], views.planar);
    const std::vector<double> weight = even_weights(views.view[i].points, kEvennessReach);
    std::vector<std::uint32_t> order = sampling_order(weight, KeyedRandom(seed, i, kThinningStage));
    const auto even = static_cast<std::size_t>(std::ceil(std::accumulate(weight.begin(), weight.end(), 0.0)));
    std::vector<bool> judges(order.size(), false);
    for (std::size_t j = kHeldOutShare - 1; j < std::min(even, order.size()); j += kHeldOutShare) {
      problem.held_out[i].push_back(order[j]);
      judges[order[j]] = true;
    }
    if (thinned)
      problem.shuffled[i] = order, order.resize(std::min(even, order.size()));
    else
      problem.shuffled[i] = order =
          sampling_order(std::vector<double>(order.size(), 1.0), KeyedRandom(seed, i, kShuffleStage));
    std::copy_if(order.begin(), order.end(), std::back_inserter(problem.fitted[i]),
                 [&](std::uint32_t j) { return !judges[j]; });
  });
  for (std::size_t i = 0; i < views_n; ++i) {
    problem.all.push_back(static_cast<int>(i));
    problem.localisations += static_cast<double>(problem.shuffled[i].size());
  }
  return problem;
}

Subsets first_of(const Subsets& subsets, std::size_t most) {
  Subsets few = subsets;
  for (auto& s : few)
    if (s.size() > most) s.resize(most);
  return few;
}

}  // namespace polar
