#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bursts.hpp"
#include "evenness.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kShuffleStage = 20, kThinningStage = 25, kHeldOutStage = 26;

// One number that is none would spoil every sum over all views.
bool is_finite(const View& view) {
  bool finite = view.points.allFinite();
  for (const Symmetric3& c : view.covariance)
    finite = finite && std::all_of(c.begin(), c.end(), [](float v) { return std::isfinite(v); });
  return finite;
}

// Whole bursts in the order in which `order` meets them, until they hold their share of the localisations;
// true for theirs.
std::vector<bool> judging_bursts(const std::vector<int>& burst, const std::vector<std::uint32_t>& order,
                                 double share) {
  const int most = burst.empty() ? -1 : *std::max_element(burst.begin(), burst.end());
  std::vector<std::size_t> size(static_cast<std::size_t>(most + 1), 0);
  for (const int b : burst)
    if (b >= 0) ++size[static_cast<std::size_t>(b)];
  std::vector<bool> judges(size.size(), false), met(size.size(), false);
  double wanted = share * static_cast<double>(order.size()), held = 0;
  for (const std::uint32_t j : order) {
    if (burst[j] < 0 || met[static_cast<std::size_t>(burst[j])]) continue;
    const auto b = static_cast<std::size_t>(burst[j]);
    met[b] = true;
    const auto n = static_cast<double>(size[b]);
    if (held + n / 2 > wanted) continue;  // a burst that is too large for the share is fitted
    judges[b] = true;
    held += n;
  }
  return judges;
}

}  // namespace

Problems make_problems(const Views& views, const EvidenceOptions& options, std::uint64_t seed,
                       const NoiseModel& noise) {
  const std::size_t n = views.view.size();
  Problem plain{views, {}, {}, {}, {}, {}, {}, {}, false, noise, seed, 0};
  plain.noise.planar = views.planar;
  plain.axes.assign(n, Eigen::Vector3f::UnitZ());
  for (auto* lists : {&plain.shuffled, &plain.sampled, &plain.fitted, &plain.held_out}) lists->resize(n);
  plain.burst.resize(n);
  Problem thinned = plain;
  thinned.crowded = true;
  parallel_for(n, [&](std::size_t i) {
    const View& view = views.view[i];
    if (!is_finite(view)) return;  // nothing of it is used, and the others go on
    plain.axes[i] = uncertainty_axis(view, views.planar);
    const std::vector<double> weight = even_weights(view.points, kEvennessReach);
    thinned.shuffled[i] = sampling_order(weight, KeyedRandom(seed, i, kThinningStage));
    plain.shuffled[i] =
        sampling_order(std::vector<double>(weight.size(), 1.0), KeyedRandom(seed, i, kShuffleStage));
    plain.burst[i] = bursts(view, plain.axes[i], plain.noise, plain.shuffled[i], options.burst_distance);
    const auto even = static_cast<std::size_t>(std::ceil(std::accumulate(weight.begin(), weight.end(), 0.0)));
    plain.sampled[i] = plain.shuffled[i];
    thinned.sampled[i] = thinned.shuffled[i];
    thinned.sampled[i].resize(std::min(even, weight.size()));
  });
  for (std::size_t i = 0; i < n; ++i) {
    plain.all.push_back(static_cast<int>(i));
    plain.localisations += static_cast<double>(views.view[i].covariance.size());
  }
  thinned.axes = plain.axes, thinned.burst = plain.burst;
  thinned.all = plain.all, thinned.localisations = plain.localisations;
  hold_out(options, 0, plain);
  hold_out(options, 0, thinned);
  return {std::move(thinned), std::move(plain)};
}

void hold_out(const EvidenceOptions& options, std::uint64_t draw, Problem& problem) {
  parallel_for(problem.size(), [&](std::size_t i) {
    const std::vector<int>& burst = problem.burst[i];
    const std::vector<std::uint32_t> order =
        random_order(burst.size(), KeyedRandom(problem.seed, i + (draw << 32), kHeldOutStage));
    const std::vector<bool> judges = judging_bursts(burst, order, options.held_out_share);
    const auto is_held_out = [&](std::uint32_t j) {
      return burst[j] >= 0 && judges[static_cast<std::size_t>(burst[j])];
    };
    problem.fitted[i].clear(), problem.held_out[i].clear();
    for (const std::uint32_t j : problem.sampled[i])
      if (!is_held_out(j)) problem.fitted[i].push_back(j);
    std::vector<int> heard(judges.size(), 0);
    for (const std::uint32_t j : order)
      if (is_held_out(j) && heard[static_cast<std::size_t>(burst[j])]++ < options.most_of_burst)
        problem.held_out[i].push_back(j);
  });
}

Evidence over_draws(const EvidenceOptions& options, int draws, Problem& problem,
                    const std::function<Evidence()>& judge,
                    const std::function<bool(const std::vector<Evidence>&)>& enough) {
  std::vector<Evidence> drawn;
  for (int d = 0; d < draws && !(enough && d > 0 && enough(drawn)); ++d) {
    hold_out(options, static_cast<std::uint64_t>(d), problem);
    drawn.push_back(judge());
  }
  return mean_over(drawn);
}

std::vector<int> evenly(const std::vector<int>& views, std::size_t most) {
  const std::size_t n = std::min(views.size(), most);
  std::vector<int> few(n);
  for (std::size_t k = 0; k < n; ++k) few[k] = views[k * views.size() / n];
  return few;
}

std::vector<int> share_at_random(const std::vector<int>& views, double share, KeyedRandom random) {
  const std::vector<std::uint32_t> order = random_order(views.size(), random);
  const auto n = static_cast<std::size_t>(std::ceil(share * static_cast<double>(views.size())));
  std::vector<int> some(n);
  for (std::size_t k = 0; k < n; ++k) some[k] = views[order[k]];
  return some;
}

Subsets first_of(const Subsets& subsets, std::size_t most) {
  Subsets few = subsets;
  for (auto& s : few)
    if (s.size() > most) s.resize(most);
  return few;
}

}  // namespace polar
