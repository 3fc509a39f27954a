#include "histogram.hpp"

#include <algorithm>
#include <cmath>

namespace polar::report {

namespace {
constexpr double kLeftOut = 0.005;
}  // namespace

std::size_t Histogram::highest() const {
  return count.empty() ? 0 : *std::max_element(count.begin(), count.end());
}

std::vector<double> sorted_finite(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !(std::abs(v) < 1e30); }),
               values.end());
  std::sort(values.begin(), values.end());
  return values;
}

double round_step(double least) {
  if (!(least > 0) || !std::isfinite(least)) return 1;
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least * (1 - 1e-9)) return step * power;
  return 10 * power;
}

Histogram histogram_between(const std::vector<double>& values, double low, double high, std::size_t bins) {
  Histogram h;
  h.low = low, h.width = (high - low) / static_cast<double>(bins);
  h.count.assign(bins, 0);
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    ++h.total;
    if (v < low) ++h.below;
    if (v > high) ++h.above;
    const double bin = std::floor((v - low) / h.width);
    ++h.count[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins - 1)))];
  }
  return h;
}

Histogram histogram(const std::vector<double>& values, std::size_t about_bins) {
  const std::vector<double> sorted = sorted_finite(values);
  if (sorted.empty()) return {};
  const double last = static_cast<double>(sorted.size() - 1);
  const double low = sorted[static_cast<std::size_t>(std::floor(kLeftOut * last))],
               high = sorted[static_cast<std::size_t>(std::ceil((1 - kLeftOut) * last))];
  const double spread = high > low ? high - low : std::max(1e-3 * std::abs(high), 1e-9) * 10;
  const double step = round_step(spread / static_cast<double>(about_bins));
  const double first = std::floor(low / step), end = std::max(std::floor(high / step) + 1, first + 1);
  return histogram_between(sorted, first * step, end * step, static_cast<std::size_t>(end - first));
}

Histogram whole_number_histogram(const std::vector<double>& values, std::size_t most_bins) {
  const std::vector<double> sorted = sorted_finite(values);
  if (sorted.empty()) return {};
  const double high = sorted.back() + 1;
  const double width = std::max(1.0, round_step(high / static_cast<double>(most_bins)));
  return histogram_between(sorted, 0, std::ceil(high / width) * width,
                           static_cast<std::size_t>(std::ceil(high / width)));
}

}  // namespace polar::report
