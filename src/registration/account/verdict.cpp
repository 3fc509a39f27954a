#include "verdict.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "../data/template_tools.hpp"

namespace polar {

namespace {

std::string text(const char* pattern, double a, double b) {
  char out[200];
  std::snprintf(out, sizeof out, pattern, a, b);
  return out;
}

}  // namespace

Comparison over_cloud(const Evidence& cloud, const Evidence& structure, const VerdictOptions& options) {
  // Localisations that the sharp template misses altogether must not outweigh all that it explains, nor a few
  // views that agree by chance all others.
  Evidence bounded = structure;
  for (std::size_t i = 0; i < bounded.size(); ++i)
    bounded[i] = cloud[i] + std::clamp(structure[i] - cloud[i], -options.most_gain, options.most_gain);
  return compare(cloud, bounded);
}

void judge_registration(const Evidence& cloud, const Evidence& evidence, const VerdictOptions& options,
                        Registration& out) {
  const Comparison c = over_cloud(cloud, evidence, options);
  out.structure_gain = c.gain, out.structure_gain_std = c.standard_error;
  if (!c.better_by(options.doubtful_standard_errors)) {
    out.verdict = Verdict::none;
    out.verdict_reason = text(
        c.gain > 0
            ? "no structure: localisations kept apart are explained by no more than %.3f +- %.3f nat better "
              "than by a cloud"
            : "no structure: a cloud explains localisations kept apart by %.3f +- %.3f nat better",
        std::abs(c.gain), c.standard_error);
    for (RegisteredView& v : out.view) {
      if (v.n_used < kFewestLocalisations) continue;  // it has a reason of its own
      v.accepted = false;
      v.reason = "the particles have no structure in common that explains localisations kept apart";
    }
    return;
  }
  double accepted = 0;
  for (const RegisteredView& v : out.view) accepted += v.accepted ? 1 : 0;
  const double share = accepted / static_cast<double>(std::max<std::size_t>(1, out.view.size()));
  const bool clear = c.better_by(options.cloud_standard_errors);
  const bool posed = share >= options.least_accepted_share;
  out.verdict = clear && posed ? Verdict::found : Verdict::ambiguous;
  out.verdict_reason =
      text(clear ? "localisations kept apart are explained by %.2f +- %.2f nat better than by a cloud"
                 : "localisations kept apart are explained by only %.2f +- %.2f nat better than by a cloud",
           c.gain, c.standard_error) +
      text(", no particle counting for more than %.2f", options.most_gain, 0) +
      (clear ? "" : ": they may have no structure in common") +
      text(posed ? "; the pose of %.0f %% of the particles is determined"
                 : "; the pose of only %.0f %% of the particles is determined",
           100 * share, 0);
}

std::string to_string(Verdict verdict) {
  return verdict == Verdict::found ? "found" : verdict == Verdict::ambiguous ? "ambiguous" : "none";
}

}  // namespace polar
