// The paper's registration (Algorithm 1): medoid, FLAMES, then joint descent, FLAMES, multistart, update and
// escape test until no view escapes, and a last joint descent.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/progress.hpp"
#include "polar/core/view.hpp"
#include "polar/latent/options.hpp"
#include "polar/model/autoencoder.hpp"

namespace polar {

/// One view's result, lengths in units of the views.
struct LatentPose {
  Pose template_from_view;
  double loss = 0;              // L_i at the end
  Pose second;                  // template_from_view of the best basin farther than T_R away
  double second_loss = -1;      // its L_i; -1: there is none
  double visibility = 1;        // used by the mask M^v
  double outlier_fraction = 0;  // used by M^o
  /// Of (rotation, translation), left perturbation x -> exp(w) x + v in the template frame: residual variance
  /// times the inverse of the normal matrix of the latent loss. The residual's entries are not independent,
  /// so this orders views by their certainty rather than measuring it.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int n_used = 0;  // localisations that took part
};

struct LatentRegistration {
  Eigen::Matrix3Xd template_points;  // D(z), units of the views
  Eigen::VectorXf z;
  std::vector<LatentPose> view;
  double loss = 0;  // the sum over views plus lambda R(z)
  int loops = 0;
  int escaped = 0;  // views that escaped in the last loop
  bool converged = false;
  std::string stopped_because = "never ran";
};

/// The same bits for any number of threads. Empty views keep the identity.
LatentRegistration register_latent(const Views& views, const Autoencoder& model, const LatentOptions& options,
                                   Progress& progress);

}  // namespace polar
