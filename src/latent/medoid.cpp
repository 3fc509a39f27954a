#include "medoid.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "polar/core/parallel.hpp"

namespace polar {

namespace {
constexpr std::size_t kMostCompared = 512;  // views, taken evenly: the comparison is quadratic
}

std::vector<int> medoids(const LatentViews& views, int most) {
  const std::vector<int> all = with_localisations(views);
  std::vector<int> some;
  const std::size_t n = std::min(all.size(), kMostCompared);
  for (std::size_t k = 0; k < n; ++k) some.push_back(all[k * all.size() / n]);
  const auto distance = [&](std::size_t a, std::size_t b) {
    const auto& x = views.view[static_cast<std::size_t>(some[a])].encoded;
    const auto& y = views.view[static_cast<std::size_t>(some[b])].encoded;
    return static_cast<double>((x - y).norm());
  };
  std::vector<double> sum(n, 0);
  parallel_for(n, [&](std::size_t a) {
    for (std::size_t b = 0; b < n; ++b) sum[a] += distance(a, b);  // argmin of it: the paper's medoid
  });
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sum[a] < sum[b]; });
  std::vector<int> taken;
  std::vector<double> apart(n, std::numeric_limits<double>::infinity());
  const std::size_t central = (n + 1) / 2;
  for (std::size_t next = n > 0 ? order[0] : 0; taken.size() < std::min(n, static_cast<std::size_t>(most));) {
    taken.push_back(some[next]);
    const std::size_t last = next;
    double farthest = 0;
    for (std::size_t k = 0; k < central; ++k) {
      const std::size_t a = order[k];
      apart[a] = std::min(apart[a], distance(a, last));
      if (apart[a] > farthest) farthest = apart[a], next = a;
    }
    if (!(farthest > 0)) break;
  }
  return taken;
}

}  // namespace polar
