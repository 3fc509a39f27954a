#include "latent_method.hpp"

#include <algorithm>
#include <cmath>

#include "../data/template_tools.hpp"
#include "polar/core/median.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar_start.hpp"

namespace polar {

namespace {

constexpr double kJudgedOutliers = 0.05;  // of the judging mixture where the latent options know of none

// Decoded points as centres of equal weight, each as wide as the distance to its nearest neighbour: a surface
// without holes.
Mixture mixture_of(const LatentRegistration& latent, bool planar, double outlier_fraction) {
  Mixture m;
  m.centre = latent.template_points.cast<float>();
  m.weight = Eigen::VectorXf::Constant(m.size(), 1.0f / static_cast<float>(m.size()));
  m.outlier_fraction = std::max(kJudgedOutliers, outlier_fraction);
  m.outlier_density = outlier_density(planar);
  sort_into_blocks(m);
  return m;
}

double spacing(const Eigen::Matrix3Xf& points) {
  std::vector<float> nearest;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    float best = INFINITY;
    for (Eigen::Index j = 0; j < points.cols(); ++j)
      if (j != i) best = std::min(best, (points.col(i) - points.col(j)).squaredNorm());
    nearest.push_back(std::sqrt(best));
  }
  return static_cast<double>(upper_median(std::move(nearest)));
}

}  // namespace

Registration latent_method(const Problem& problem, const Autoencoder& model,
                           const RegistrationOptions& options, Progress& progress) {
  const LatentRegistration latent = register_latent(problem.views, model, latent_options(options), progress);
  Registration out;
  out.view.resize(problem.size());
  out.rounds = latent.loops;
  out.converged = latent.converged;
  out.stopped_because = latent.stopped_because;
  if (latent.template_points.cols() == 0 || progress.cancelled()) return out;
  const Mixture mixture = mixture_of(latent, problem.planar(), options.latent.outlier_fraction);
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = spacing(mixture.centre);
  std::vector<Pose> pose, second;
  for (const LatentPose& p : latent.view) {
    pose.push_back(p.template_from_view);
    second.push_back(p.second_loss >= 0 ? p.second : p.template_from_view);
  }
  const FusionData data(problem.views, problem.axes, noise, problem.shuffled);
  const std::vector<double> best = mean_log_likelihood(mixture, data, pose);
  const std::vector<double> other = mean_log_likelihood(mixture, data, second);
  for (std::size_t i = 0; i < problem.size(); ++i) {
    RegisteredView& v = out.view[i];
    const LatentPose& p = latent.view[i];
    v.template_from_view = p.template_from_view;
    v.covariance = p.covariance;
    v.log_likelihood = best[i];
    v.margin = std::max(0.0, best[i] - other[i]);
    v.outlier_fraction = p.outlier_fraction;
    v.visibility = p.visibility;
    v.n_used = p.n_used;
    v.accepted = p.n_used >= kFewestLocalisations;
    v.reason = v.accepted ? "" : too_few_localisations();
  }
  out.fused.centre = mixture.centre.cast<double>();
  out.fused.weight = mixture.weight.cast<double>();
  out.fused.width = noise.width;
  out.fused.outlier_fraction = mixture.outlier_fraction;
  out.fused.outlier_density = mixture.outlier_density;
  out.starts.push_back({"polar", 0, 0, 0, true});
  out.verdict = Verdict::ambiguous;
  out.verdict_reason = "the latent method gives poses, not evidence: no localisation was held out";
  return out;
}

}  // namespace polar
