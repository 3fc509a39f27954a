// One view's term of the registration loss (paper III.D, its last equation), with its derivatives:
//
//   L_i(z, rho_i) = || E(M^v(nu_i(rho_i D(z)))) - E(M^o(X_i)) ||^2
//
// nu_i adds noise to the template as the microscope did: each localisation lends its covariance to one
// template point. The draws are made once (common random numbers), so the loss is a function.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/view.hpp"
#include "polar/latent/options.hpp"
#include "polar/model/autoencoder.hpp"

namespace polar {

/// A view as the loss sees it, lengths in units of the autoencoder.
struct LatentView {
  Eigen::Matrix3Xf points;              // 3 x n, a fair sample of the view's localisations
  std::vector<Eigen::Matrix3f> spread;  // n, square roots of their covariances
  Eigen::VectorXf encoded;              // E(X_i) without mask; empty for an empty view
  Eigen::Matrix3Xf noise;               // 3 x m: nu_i, in the frame of the view
  std::vector<int> source;              // m: the decoded point that each draw starts from
  double visibility = 1;                // share of the template that M^v keeps
  double outlier_fraction = 0;          // share of the view that M^o drops

  bool empty() const { return points.cols() == 0; }
};

struct LatentViews {
  std::vector<LatentView> view;  // in the order of the input, empty ones too
  double scale = 1;              // x_latent = scale * x_view
  bool planar = false;
};

/// Samples localisations, draws noise and encodes every view. All draws are keyed by (seed, view).
LatentViews latent_views(const Views& views, const Autoencoder& model, const LatentOptions& options);

/// The views that are not empty.
std::vector<int> with_localisations(const LatentViews& views);

/// Sets both ratios of view `number` and makes its draws: with matched counts as many as leave equal clouds
/// behind both masks, else one of every decoded point.
void set_degradation(LatentView& view, std::uint64_t number, int decoded_points, double visibility,
                     double outlier_fraction, const LatentOptions& options);

enum class Derive { nothing, pose, pose_and_template };

struct LossTerm {
  double loss = 0;
  Eigen::VectorXf residual;  // latent of the template's view minus latent of the view
  /// d residual / d(w, v), the pose perturbed as in `stepped`; the masks are held.
  Eigen::Matrix<float, Eigen::Dynamic, 6> jacobian;
  Eigen::Matrix3Xf template_gradient;  // dL_i / dP for P = D(z), 3 x decoded points, frame of the template
};

/// view_from_template turned and shifted from the left about the template's origin: R -> exp([w]_x) R,
/// t -> t + v for delta = (w, v).
Pose stepped(const Pose& view_from_template, const Eigen::Matrix<double, 6, 1>& delta);

/// 0 for an empty view.
LossTerm view_loss(const Autoencoder& model, const LatentView& view, const Eigen::Matrix3Xf& template_points,
                   const Pose& view_from_template, Derive derive);

/// The template as view `view` would show it: turned, shifted, noised, masked (what `view_loss` encodes).
Eigen::Matrix3Xf simulated_view(const LatentView& view, const Eigen::Matrix3Xf& template_points,
                                const Pose& view_from_template);

}  // namespace polar
