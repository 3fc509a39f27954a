#include "problem.hpp"

#include <algorithm>
#include <numeric>

#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kShuffleStage = 20;
constexpr std::size_t kHeldOutShare = 5;  // one localisation in five judges
}  // namespace

Problem make_problem(const Views& views, std::uint64_t seed) {
  Problem problem{views, {}, {}, {}, {}, {}, seed, 0};
  for (std::size_t i = 0; i < views.view.size(); ++i) {
    const std::size_t n = views.view[i].covariance.size();
    problem.axes.push_back(uncertainty_axis(views.view[i], views.planar));
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    KeyedRandom random(seed, i, kShuffleStage);
    for (std::size_t j = 0; j + 1 < n; ++j) std::swap(order[j], order[j + random.below(n - j)]);
    const auto kept = static_cast<std::ptrdiff_t>(n - n / kHeldOutShare);
    problem.fitted.emplace_back(order.begin(), order.begin() + kept);
    problem.held_out.emplace_back(order.begin() + kept, order.end());
    problem.shuffled.push_back(std::move(order));
    problem.all.push_back(static_cast<int>(i));
    problem.localisations += static_cast<double>(n);
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
