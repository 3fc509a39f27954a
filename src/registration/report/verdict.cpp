#include "verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../data/template_tools.hpp"
#include "polar/core/constants.hpp"

namespace polar {

namespace {

constexpr double kOfAShell = 40;  // localisations: a shell's density errs by a sixth
constexpr double kMostShells = 32;
constexpr double kOutliers = 0.02;

double distance(const Problem& problem, std::size_t view, std::uint32_t j) {
  return static_cast<double>(problem.views.view[view].points.col(static_cast<Eigen::Index>(j)).norm());
}

double volume(double radius, bool planar) {
  return planar ? kPi * radius * radius : 4 * kPi / 3 * radius * radius * radius;
}

std::string text(const char* pattern, double a, double b) {
  char out[200];
  std::snprintf(out, sizeof out, pattern, a, b);
  return out;
}

}  // namespace

Evidence cloud_evidence(const Problem& problem) {
  std::vector<double> fitted;
  for (std::size_t i = 0; i < problem.size(); ++i)
    for (const std::uint32_t j : problem.fitted[i]) fitted.push_back(distance(problem, i, j));
  Evidence out(problem.size(), NAN);
  if (fitted.empty()) return out;
  std::sort(fitted.begin(), fitted.end());
  const auto shells =
      static_cast<std::size_t>(std::clamp(static_cast<double>(fitted.size()) / kOfAShell, 1.0, kMostShells));
  std::vector<double> edge = {0};  // shells of as many localisations each
  for (std::size_t s = 1; s <= shells; ++s) edge.push_back(fitted[s * fitted.size() / shells - 1]);
  for (std::size_t i = 0; i < problem.size(); ++i) {
    if (problem.held_out[i].empty()) continue;
    double total = 0;
    for (const std::uint32_t j : problem.held_out[i]) {
      const auto outer = std::lower_bound(edge.begin() + 1, edge.end(), distance(problem, i, j));
      double density = kOutliers * outlier_density(problem.planar());
      if (outer != edge.end()) {
        const double shell = volume(*outer, problem.planar()) - volume(*(outer - 1), problem.planar());
        density += (1 - kOutliers) / static_cast<double>(shells) / std::max(shell, 1e-12);
      }
      total += std::log(density);
    }
    out[i] = total / static_cast<double>(problem.held_out[i].size());
  }
  return out;
}

void judge_registration(const Problem& problem, const Evidence& evidence, const VerdictOptions& options,
                        Registration& out) {
  const Comparison c = compare(cloud_evidence(problem), evidence);
  out.structure_gain = c.gain, out.structure_gain_std = c.standard_error;
  if (!c.better_by(options.cloud_standard_errors)) {
    out.verdict = Verdict::none;
    out.verdict_reason =
        text("no structure: localisations kept apart are explained by %.3f +- %.3f nat better than by a cloud",
             c.gain, c.standard_error);
    for (RegisteredView& v : out.view)
      if (v.accepted) {
        v.accepted = false;
        v.reason = "the particles have no structure in common that explains localisations kept apart";
      }
    return;
  }
  double accepted = 0;
  for (const RegisteredView& v : out.view) accepted += v.accepted ? 1 : 0;
  const double share = accepted / static_cast<double>(std::max<std::size_t>(1, out.view.size()));
  out.verdict = share >= options.least_accepted_share ? Verdict::found : Verdict::ambiguous;
  out.verdict_reason =
      text("localisations kept apart are explained by %.2f +- %.2f nat better than by a cloud", c.gain,
           c.standard_error) +
      text(out.verdict == Verdict::found ? "; the pose of %.0f %% of the particles is determined"
                                         : ", but the pose of only %.0f %% of the particles is determined",
           100 * share, 0);
}

std::string to_string(Verdict verdict) {
  return verdict == Verdict::found ? "found" : verdict == Verdict::ambiguous ? "ambiguous" : "none";
}

}  // namespace polar
