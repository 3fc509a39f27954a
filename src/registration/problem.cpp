#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "evenness.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kShuffleStage = 20, kThinningStage = 25;
constexpr std::size_t kReachLocalisations = 500;  // that tell how far a view reaches
constexpr std::size_t kHeldOutShare = 5;          // one localisation in five judges

// One number that is none would spoil every sum over all views.
bool is_finite(const View& view) {
  bool finite = view.points.allFinite();
  for (const Symmetric3& c : view.covariance)
    finite = finite && std::all_of(c.begin(), c.end(), [](float v) { return std::isfinite(v); });
  return finite;
}
}  // namespace

Problems make_problems(const Views& views, std::uint64_t seed) {
  const std::size_t n = views.view.size();
  Problem plain{views, {}, {}, {}, {}, {}, {}, seed, 0};
  plain.reach.resize(n);
  plain.axes.resize(n), plain.shuffled.resize(n), plain.fitted.resize(n), plain.held_out.resize(n);
  Problem thinned = plain;
  parallel_for(n, [&](std::size_t i) {
    plain.axes[i] = Eigen::Vector3f::UnitZ();
    if (!is_finite(views.view[i])) return;  // nothing of it is used, and the others go on
    plain.axes[i] = uncertainty_axis(views.view[i], views.planar);
    const std::vector<double> weight = even_weights(views.view[i].points, kEvennessReach);
    thinned.shuffled[i] = sampling_order(weight, KeyedRandom(seed, i, kThinningStage));
    plain.shuffled[i] =
        sampling_order(std::vector<double>(weight.size(), 1.0), KeyedRandom(seed, i, kShuffleStage));
    if (!views.planar) {
      std::vector<std::uint32_t> few = plain.shuffled[i];
      few.resize(std::min(few.size(), kReachLocalisations));
      plain.reach[i] = reach_of(views.view[i].points(Eigen::all, few));
    }
    std::vector<std::uint32_t> even = thinned.shuffled[i];
    even.resize(std::min(even.size(), static_cast<std::size_t>(
                                          std::ceil(std::accumulate(weight.begin(), weight.end(), 0.0)))));
    std::vector<bool> judges(weight.size(), false);
    for (std::size_t j = kHeldOutShare - 1; j < even.size(); j += kHeldOutShare) {
      plain.held_out[i].push_back(even[j]);
      judges[even[j]] = true;
    }
    const auto fit = [&](const std::vector<std::uint32_t>& order, std::vector<std::uint32_t>& fitted) {
      std::copy_if(order.begin(), order.end(), std::back_inserter(fitted),
                   [&](std::uint32_t j) { return !judges[j]; });
    };
    fit(even, thinned.fitted[i]);
    fit(plain.shuffled[i], plain.fitted[i]);
  });
  for (std::size_t i = 0; i < n; ++i) {
    plain.all.push_back(static_cast<int>(i));
    plain.localisations += static_cast<double>(views.view[i].covariance.size());
  }
  thinned.reach = plain.reach;
  thinned.axes = plain.axes, thinned.held_out = plain.held_out;
  thinned.all = plain.all, thinned.localisations = plain.localisations;
  return {std::move(thinned), std::move(plain)};
}

std::vector<int> some_views(const Problem& problem, std::size_t most) {
  const std::size_t n = std::min(problem.size(), most);
  std::vector<int> few(n);
  for (std::size_t k = 0; k < n; ++k) few[k] = static_cast<int>(k * problem.size() / n);
  return few;
}

std::size_t median_size(const Subsets& subsets, const std::vector<int>& which) {
  std::vector<std::size_t> size;
  size.reserve(which.size());
  for (const int i : which) size.push_back(subsets[static_cast<std::size_t>(i)].size());
  return size.empty() ? 0 : upper_median(std::move(size));
}

Subsets first_of(const Subsets& subsets, std::size_t most) {
  Subsets few = subsets;
  for (auto& s : few)
    if (s.size() > most) s.resize(most);
  return few;
}

}  // namespace polar
