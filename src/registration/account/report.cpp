#include "report.hpp"

#include <algorithm>
#include <cmath>

#include "../data/bursts.hpp"
#include "../data/template_tools.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/polish.hpp"

namespace polar {

namespace {

// Of the poses at this mode against one at least 15 degrees away, tempered as the bursts ask: a likelihood
// that counts the blinks of one label as many says as little as one of them.
double posterior_share(double margin, double localisations, double temper) {
  return 1 / (1 + std::exp(-temper * margin * localisations));
}

std::string reason(const RegisteredView& v, const VerdictOptions& o) {
  const double rotation_std = std::sqrt(std::max(0.0, v.covariance.topLeftCorner<3, 3>().trace()));
  if (v.n_used < kFewestLocalisations) return too_few_localisations();
  if (!v.template_from_view.rotation.allFinite() || !v.template_from_view.translation.allFinite() ||
      !v.covariance.allFinite() || !std::isfinite(v.log_likelihood))
    return "its registration did not end in finite numbers";
  if (v.outlier_fraction > o.most_outliers) return "the template explains too few of its localisations";
  if (!(rotation_std < o.most_rotation_std_deg * kRadiansPerDegree)) return "its rotation is not determined";
  if (v.posterior_share < o.least_posterior_share) return "another pose explains it nearly as well";
  return "";
}

}  // namespace

FusedTemplate fused_template(const Fit& fit) {
  FusedTemplate out;
  out.centre = fit.mixture.centre.cast<double>();
  out.weight = fit.mixture.weight.cast<double>();
  out.width = std::hypot(fit.noise.width, fit.noise.lateral_extra);
  out.outlier_fraction = fit.mixture.outlier_fraction;
  out.outlier_density = fit.mixture.outlier_density;
  return out;
}

void report_views(const Problem& problem, const EngineOptions& options, Fit& fit, Registration& out) {
  FusionData data(problem.views, problem.axes, fit.noise, problem.shuffled);
  std::vector<std::vector<int>> burst(problem.size());
  parallel_for(problem.size(), [&](std::size_t i) {
    const std::vector<int> of = bursts(problem.views.view[i], problem.axes[i], problem.noise,
                                       problem.shuffled[i], options.evidence.burst_distance);
    for (const std::uint32_t j : problem.shuffled[i]) burst[i].push_back(of[j]);  // in the order of the data
  });
  // Least squares, one step of the template, and least squares again.
  show(fit, fit.mixture, data);
  fit.pose = polished_poses(fit.mixture, data, fit.pose);
  MaximisationOptions em;
  em.free_weights = true;
  em.support = problem.crowded || !fit.group.empty();
  em.weakest_share = 0;
  em.group = fit.group;
  maximise(fit.mixture, data, fit.pose, em);
  show(fit, fit.mixture, data);
  const std::vector<PolishedPose> polished = polish(fit.mixture, data, fit.pose, burst);
  for (std::size_t i = 0; i < polished.size(); ++i) fit.pose[i] = polished[i].template_from_view;
  out.view.resize(problem.size());
  for (std::size_t i = 0; i < problem.size(); ++i) {
    RegisteredView& v = out.view[i];
    const PolishedPose& p = polished[i];
    v.template_from_view = p.template_from_view;
    v.covariance = p.covariance;
    v.log_likelihood = p.log_likelihood;
    v.outlier_fraction = p.outlier_fraction;
    v.margin = std::isfinite(fit.margin[i]) ? fit.margin[i] : 0;
    v.visibility = shown_share(fit.mixture, data.visibility(i));
    v.n_used = static_cast<int>(problem.shuffled[i].size());
    v.posterior_share = std::isfinite(fit.margin[i]) ? posterior_share(fit.margin[i], v.n_used, p.temper) : 1;
    v.reason = reason(v, options.verdict);
    v.accepted = v.reason.empty();
  }
  out.fused = fused_template(fit);
  out.calibration = {fit.noise.lateral_factor, fit.noise.axial_factor, fit.noise.lateral_extra,
                     fit.noise.axial_extra};
}

}  // namespace polar
