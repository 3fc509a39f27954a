#include "polar/results/strangers.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/median.hpp"

namespace polar {

namespace {
constexpr std::size_t kFewest = 10;
constexpr double kFar = 6;               // Gaussian particles: one in 500 million
constexpr double kNormalOfMad = 1.4826;  // the standard deviation of a normal with this MAD
constexpr double kSmallestScale = 0.02;  // nat: what says nothing however alike the others are

// The middle of the values and their robust standard deviation.
struct Spread {
  double middle, scale;
};

Spread spread_of(const std::vector<double>& value) {
  const double middle = upper_median(value);
  std::vector<double> distance;
  for (const double v : value) distance.push_back(std::abs(v - middle));
  return {middle, std::max(kNormalOfMad * upper_median(distance), kSmallestScale)};
}
}  // namespace

StrangerLimits stranger_limits(const std::vector<double>& value) {
  if (value.size() < kFewest) return {};
  const Spread spread = spread_of(value);
  return {spread.middle - kFar * spread.scale, spread.middle + kFar * spread.scale};
}

std::vector<Stranger> strangers(const std::vector<PoseRow>& rows) {
  std::vector<double> value;
  for (const PoseRow& row : rows)
    if (row.accepted && std::isfinite(row.log_likelihood)) value.push_back(row.log_likelihood);
  if (value.size() < kFewest) return {};
  const Spread spread = spread_of(value);
  std::vector<Stranger> found;
  for (const PoseRow& row : rows) {
    const double deviation = (row.log_likelihood - spread.middle) / spread.scale;
    if (row.accepted && std::abs(deviation) > kFar) found.push_back({row.particle, deviation});
  }
  std::stable_sort(found.begin(), found.end(), [](const Stranger& a, const Stranger& b) {
    return std::abs(a.deviation) > std::abs(b.deviation);
  });
  return found;
}

}  // namespace polar
