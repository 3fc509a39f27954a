#include "condition_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polar/core/rng.hpp"

namespace polar::pipeline {

namespace {
constexpr std::uint32_t kBootstrapStage = 0xa1;

struct Condition {
  std::string name;
  std::vector<double> values;
};

std::vector<Condition> conditions_of(const std::vector<Observation>& observations) {
  std::vector<Condition> conditions;
  for (const Observation& o : observations) {
    if (!std::isfinite(o.value)) continue;
    auto found = std::find_if(conditions.begin(), conditions.end(),
                              [&](const Condition& c) { return c.name == o.condition; });
    if (found == conditions.end()) found = conditions.insert(conditions.end(), {o.condition, {}});
    found->values.push_back(o.value);
  }
  return conditions;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// The condition's mean in every draw, widened about its own; empty where one data set says nothing of it.
std::vector<double> drawn_means(const Condition& c, const BootstrapOptions& options, KeyedRandom random) {
  const std::size_t n = c.values.size();
  if (n < 2) return {};
  const double mean = mean_of(c.values), widening = std::sqrt(double(n) / double(n - 1));
  std::vector<double> drawn(static_cast<std::size_t>(options.draws));
  for (double& d : drawn) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += c.values[random.below(n)];
    d = mean + widening * (sum / double(n) - mean);
  }
  return drawn;
}

void set_interval(std::vector<double> drawn, double level, ConditionMean& m) {
  m.low = m.high = std::numeric_limits<double>::quiet_NaN();
  if (drawn.empty()) return;
  std::sort(drawn.begin(), drawn.end());
  const double tail = (1 - level) / 2, last = static_cast<double>(drawn.size() - 1);
  m.low = drawn[static_cast<std::size_t>(std::floor(tail * last))];
  m.high = drawn[static_cast<std::size_t>(std::ceil((1 - tail) * last))];
}
}  // namespace

std::vector<ConditionMean> condition_means(const std::vector<Observation>& observations,
                                           const BootstrapOptions& options, std::uint64_t item) {
  const std::vector<Condition> conditions = conditions_of(observations);
  std::vector<std::vector<double>> drawn;
  std::vector<ConditionMean> means;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const Condition& c = conditions[i];
    const auto stage = kBootstrapStage + (static_cast<std::uint32_t>(i) << 8);
    drawn.push_back(drawn_means(c, options, KeyedRandom(options.seed, item, stage)));
    ConditionMean m{c.name, {}, c.values.size(), 0, mean_of(c.values)};
    set_interval(drawn.back(), options.level, m);
    means.push_back(m);
  }
  for (std::size_t i = 0; i < conditions.size(); ++i)
    for (std::size_t j = i + 1; j < conditions.size(); ++j) {
      const Condition &a = conditions[j], &b = conditions[i];
      ConditionMean m{a.name, b.name, a.values.size(), b.values.size(),
                      mean_of(a.values) - mean_of(b.values)};
      std::vector<double> difference = drawn[j];
      if (drawn[i].empty()) difference.clear();
      for (std::size_t k = 0; k < difference.size(); ++k) difference[k] -= drawn[i][k];
      set_interval(std::move(difference), options.level, m);
      means.push_back(m);
    }
  return means;
}

}  // namespace polar::pipeline
