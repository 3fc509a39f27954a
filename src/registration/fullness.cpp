#include "fullness.hpp"

#include <algorithm>

namespace polar {

namespace {
constexpr float kSpot = 0.15f;  // particle radii
}

double occupied_spots(const Eigen::Matrix3Xf& points, const std::vector<std::uint32_t>& which, float reach) {
  if (which.empty()) return 0;
  std::size_t pairs = 0;
  for (const std::uint32_t a : which)
    for (const std::uint32_t b : which)
      if ((points.col(a) - points.col(b)).squaredNorm() <= reach * reach) ++pairs;
  const auto n = static_cast<double>(which.size());
  return n * n / static_cast<double>(pairs);
}

std::vector<int> fullest_views(const Problem& problem, const Subsets& subset, std::size_t most) {
  std::vector<double> spots;
  spots.reserve(problem.size());
  for (std::size_t i = 0; i < problem.size(); ++i)
    spots.push_back(occupied_spots(problem.views.view[i].points, subset[i], kSpot));
  std::vector<int> view = problem.all;
  std::stable_sort(view.begin(), view.end(), [&](int a, int b) {
    return spots[static_cast<std::size_t>(a)] > spots[static_cast<std::size_t>(b)];
  });
  view.resize(std::min(most, view.size()));
  return view;
}

}  // namespace polar
