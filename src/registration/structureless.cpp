#include "structureless.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr double kOfAShell = 40;  // localisations
constexpr double kMostShells = 32;
constexpr double kOutliers = 0.02;
constexpr double kLeastGain =
    0.05;  // nat a localisation: noise reaches this, a house blurred by 0.15 radii 0.23
constexpr double kStandardErrors =
    2.0;  // of a gain that differs by about 1 nat from one localisation to another

std::vector<double> distances(const Problem& problem, const Subsets& subsets) {
  std::vector<double> out;
  for (std::size_t i = 0; i < subsets.size(); ++i)
    for (const std::uint32_t j : subsets[i])
      out.push_back(
          static_cast<double>(problem.views.view[i].points.col(static_cast<Eigen::Index>(j)).norm()));
  return out;
}

double volume(double radius, bool planar) {
  return planar ? kPi * radius * radius : 4 * kPi / 3 * radius * radius * radius;
}

}  // namespace

double structureless_score(const Problem& problem) {
  std::vector<double> fitted = distances(problem, problem.fitted);
  const std::vector<double> judged = distances(problem, problem.held_out);
  if (fitted.empty() || judged.empty()) return 0;
  std::sort(fitted.begin(), fitted.end());
  const auto shells =
      static_cast<std::size_t>(std::clamp(static_cast<double>(fitted.size()) / kOfAShell, 1.0, kMostShells));
  std::vector<double> edge = {0};  // shells of as many localisations each
  for (std::size_t s = 1; s <= shells; ++s) edge.push_back(fitted[s * fitted.size() / shells - 1]);
  double total = 0;
  for (const double r : judged) {
    const auto outer = std::lower_bound(edge.begin() + 1, edge.end(), r);
    double density = kOutliers * outlier_density(problem.planar());
    if (outer != edge.end()) {
      const double shell = volume(*outer, problem.planar()) - volume(*(outer - 1), problem.planar());
      density += (1 - kOutliers) / static_cast<double>(shells) / std::max(shell, 1e-12);
    }
    total += std::log(density);
  }
  return total / static_cast<double>(judged.size());
}

bool explains_no_more_than_a_cloud(const Problem& problem, double held_out_score) {
  std::size_t judged = 0;
  for (const auto& s : problem.held_out) judged += s.size();
  if (judged == 0) return false;
  const double error = 1 / std::sqrt(static_cast<double>(judged));
  return held_out_score - structureless_score(problem) < kLeastGain + kStandardErrors * error;
}

}  // namespace polar
