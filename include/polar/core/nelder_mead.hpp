// J. A. Nelder, R. Mead, A simplex method for function minimization, The Computer Journal 7, 1965: for few
// parameters and a cost with no cheap derivative.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace polar {

struct NelderMeadOptions {
  double step = 0.1;        // of the first simplex along every parameter
  double tolerance = 1e-4;  // spread of the simplex's costs at which it ends
  int most_evaluations = 100;
};

/// The best parameters found from `start` on; cost(parameters) is a double.
template <typename Cost>
std::vector<double> nelder_mead(const std::vector<double>& start, const NelderMeadOptions& options,
                                Cost cost) {
  using Parameters = std::vector<double>;
  const std::size_t n = start.size();
  std::vector<Parameters> vertex(n + 1, start);
  std::vector<double> value(n + 1);
  for (std::size_t i = 0; i < n; ++i) vertex[i + 1][i] += options.step;
  int evaluations = 0;
  const auto at = [&](const Parameters& p) { return ++evaluations, cost(p); };
  for (std::size_t i = 0; i <= n; ++i) value[i] = at(vertex[i]);
  std::vector<std::size_t> order(n + 1);
  while (evaluations < options.most_evaluations) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
    const std::size_t best = order[0], worst = order[n], second = order[n - 1];
    if (value[worst] - value[best] < options.tolerance) break;
    Parameters middle(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t d = 0; d < n; ++d) middle[d] += vertex[order[i]][d] / static_cast<double>(n);
    const auto towards = [&](double t) {
      Parameters p(n);
      for (std::size_t d = 0; d < n; ++d) p[d] = middle[d] + t * (vertex[worst][d] - middle[d]);
      return p;
    };
    const Parameters reflected = towards(-1);
    const double r = at(reflected);
    if (r < value[best]) {
      const Parameters expanded = towards(-2);
      const double e = at(expanded);
      vertex[worst] = e < r ? expanded : reflected;
      value[worst] = std::min(e, r);
    } else if (r < value[second]) {
      vertex[worst] = reflected, value[worst] = r;
    } else {
      const Parameters inside = towards(r < value[worst] ? -0.5 : 0.5);
      const double c = at(inside);
      if (c < std::min(r, value[worst])) {
        vertex[worst] = inside, value[worst] = c;
        continue;
      }
      for (std::size_t i = 1; i <= n; ++i) {
        for (std::size_t d = 0; d < n; ++d)
          vertex[order[i]][d] = 0.5 * (vertex[order[i]][d] + vertex[best][d]);
        value[order[i]] = at(vertex[order[i]]);
      }
    }
  }
  return vertex[static_cast<std::size_t>(std::min_element(value.begin(), value.end()) - value.begin())];
}

}  // namespace polar
