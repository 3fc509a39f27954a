#include "polar/flames/local_minima.hpp"

#include <algorithm>

namespace polar {

std::vector<int> local_minima(const std::vector<float>& cost, const NeighbourGraph& graph, int most) {
  std::vector<int> minima;
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const std::int32_t* neighbour = graph.of(i);
    bool lowest = cost[i] == cost[i];
    for (int j = 0; lowest && j < graph.degree; ++j) {
      const auto n = static_cast<std::size_t>(neighbour[j]);
      lowest = !(cost[n] < cost[i] || (cost[n] == cost[i] && n < i));
    }
    if (lowest) minima.push_back(static_cast<int>(i));
  }
  const auto cheaper = [&](int a, int b) {
    const float ca = cost[static_cast<std::size_t>(a)], cb = cost[static_cast<std::size_t>(b)];
    return ca < cb || (ca == cb && a < b);
  };
  const std::size_t kept = std::min(minima.size(), static_cast<std::size_t>(std::max(0, most)));
  std::partial_sort(minima.begin(), minima.begin() + static_cast<std::ptrdiff_t>(kept), minima.end(),
                    cheaper);
  minima.resize(kept);
  return minima;
}

}  // namespace polar
