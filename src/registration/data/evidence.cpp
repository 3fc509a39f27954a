#include "evidence.hpp"

#include <algorithm>
#include <cmath>

namespace polar {

double mean_evidence(const Evidence& evidence) {
  double sum = 0, n = 0;
  for (const double e : evidence)
    if (std::isfinite(e)) sum += e, ++n;
  return n > 0 ? sum / n : 0;
}

Evidence mean_over(const std::vector<Evidence>& draws) {
  Evidence out(draws.empty() ? 0 : draws.front().size(), NAN);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double sum = 0, n = 0;
    for (const Evidence& e : draws)
      if (std::isfinite(e[i])) sum += e[i], ++n;
    if (n > 0) out[i] = sum / n;
  }
  return out;
}

Comparison compare(const Evidence& a, const Evidence& b) {
  Comparison out;
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double d = b[i] - a[i];
    if (!std::isfinite(d)) continue;
    sum += d, squares += d * d, ++out.views;
  }
  if (out.views == 0) return out;
  const double n = out.views;
  out.gain = sum / n;
  out.standard_error = std::sqrt(std::max(0.0, squares / n - out.gain * out.gain) / std::max(1.0, n - 1));
  return out;
}

}  // namespace polar
