#include "polar/results/labelling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace polar {

namespace {
constexpr double kHalfChiSquare = 1.920729;  // half of chi^2 with one degree of freedom at 95 %
constexpr double kMissing = 3;               // standard deviations below what is expected
constexpr double kLeast = 1e-6;              // probabilities stay this far from 0 and 1
constexpr double kLeastInformation = 0.05;

// log P(n) of a binomial distribution.
double log_probability(int n, int sites, double q) {
  return std::lgamma(sites + 1.0) - std::lgamma(n + 1.0) - std::lgamma(sites - n + 1.0) + n * std::log(q) +
         (sites - n) * std::log1p(-q);
}

double at_least(int fewest, int sites, double q) {
  double p = 0;
  for (int n = fewest; n <= sites; ++n) p += std::exp(log_probability(n, sites, q));
  return std::max(p, 1e-300);
}

// The counts that are not below `fewest`.
struct Counts {
  int fewest, sites;
  double particles = 0, sum = 0, squares = 0;
  Counts(const std::vector<double>& with, int least)
      : fewest(least), sites(static_cast<int>(with.size()) - 1) {
    for (int n = least; n <= sites; ++n) {
      const double seen = with[static_cast<std::size_t>(n)];
      particles += seen, sum += seen * n, squares += seen * n * n;
    }
  }
  double log_likelihood(double q) const {
    return sum * std::log(q) + (particles * sites - sum) * std::log1p(-q) -
           particles * std::log(at_least(fewest, sites, q));
  }
};

// Golden section: the likelihood has one maximum.
double best(const Counts& c) {
  constexpr double kGolden = 0.6180339887498949;
  double low = kLeast, high = 1 - kLeast;
  while (high - low > 1e-9) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    (c.log_likelihood(a) < c.log_likelihood(b) ? low : high) =
        c.log_likelihood(a) < c.log_likelihood(b) ? a : b;
  }
  return (low + high) / 2;
}

// Where the likelihood has fallen by `drop` between its maximum and `end`.
double fallen(const Counts& c, double q, double end, double drop) {
  const double level = c.log_likelihood(q) - drop;
  if (c.log_likelihood(end) > level) return end;
  double inside = q, outside = end;
  while (std::abs(outside - inside) > 1e-9) {
    const double middle = (inside + outside) / 2;
    (c.log_likelihood(middle) > level ? inside : outside) = middle;
  }
  return inside;
}

// How many particles the counts that are not below `fewest` make one expect between `from` and `fewest`.
double expected_between(const Counts& c, int from) {
  const double q = best(c);
  return c.particles * (at_least(from, c.sites, q) / at_least(c.fewest, c.sites, q) - 1);
}

int fewest_seen(const std::vector<double>& with) {
  const int sites = static_cast<int>(with.size()) - 1;
  int fewest = 1;
  while (fewest < sites && !(with[static_cast<std::size_t>(fewest)] > 0)) ++fewest;
  if (fewest == sites) return 1;  // every site of every particle: nothing is missing
  // Those that chance left in although most like them are missing. Two different counts must stay above: one
  // alone, every site, would be explained by any efficiency.
  for (; fewest + 1 < sites; ++fewest) {
    const Counts above(with, fewest + 1);
    if (above.particles < 1) break;
    const double expected = expected_between(above, fewest);
    const double seen = with[static_cast<std::size_t>(fewest)];
    if (seen >= expected - kMissing * std::sqrt(expected)) break;
  }
  const Counts kept(with, fewest);
  const double expected = expected_between(kept, 1);
  const double seen = std::accumulate(with.begin() + 1, with.begin() + fewest, 0.0);
  return seen >= expected - std::sqrt(expected) ? 1 : fewest;
}

// Variance of the truncated distribution.
double variance(const Counts& c, double q) {
  double mean = 0, square = 0;
  for (int n = c.fewest; n <= c.sites; ++n) {
    const double p = std::exp(log_probability(n, c.sites, q)) / at_least(c.fewest, c.sites, q);
    mean += p * n, square += p * n * n;
  }
  return square - mean * mean;
}

// Variance of the counts over that of the truncated distribution.
double dispersion(const Counts& c, double expected) {
  if (c.particles < 2 || !(expected > 0)) return 1;
  const double observed = (c.squares - c.sum * c.sum / c.particles) / (c.particles - 1);
  return observed / expected;
}
}  // namespace

bool PlaceCounts::any() const {
  return std::any_of(occupancy.begin(), occupancy.end(), [](double o) { return o > 0; });
}

Labelling labelling_efficiency(const PlaceCounts& counts, int labels_per_site) {
  Labelling l;
  l.sites = static_cast<int>(counts.occupancy.size());
  l.labels_per_site = labels_per_site;
  l.fewest = fewest_seen(counts.particles);
  const Counts c(counts.particles, l.fewest);
  l.particles = static_cast<std::size_t>(std::lround(c.particles));
  const double q = best(c);
  const double expected = variance(c, q);
  l.dispersion = dispersion(c, expected);
  if (expected > 0) l.information = std::clamp(1 - counts.doubt / expected, kLeastInformation, 1.0);
  const double drop = kHalfChiSquare * std::max(1.0, l.dispersion) / l.information;
  const auto one_label = [&](double site) { return 1 - std::pow(1 - site, 1.0 / labels_per_site); };
  l.efficiency = one_label(q);
  l.low = one_label(fallen(c, q, kLeast, drop));
  l.high = one_label(fallen(c, q, 1 - kLeast, drop));
  return l;
}

}  // namespace polar
