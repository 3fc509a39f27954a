// Descent of poses and template on the latent loss: Levenberg-Marquardt on so(3) x R^3, and the paper's
// AdamW.
#pragma once

#include <vector>

#include "polar/core/progress.hpp"
#include "polar/latent/loss.hpp"

namespace polar {

/// First and second moments of one group of parameters.
class AdamW {
 public:
  AdamW() = default;
  explicit AdamW(Eigen::Index size)
      : first_(Eigen::VectorXd::Zero(size)), second_(Eigen::VectorXd::Zero(size)) {}
  /// The step to add; decoupled weight decay is the caller's.
  Eigen::VectorXd step(const Eigen::VectorXd& gradient, double rate);

 private:
  Eigen::VectorXd first_, second_;
  int steps_ = 0;
};

/// Learning rate that falls by `factor` after `patience` steps without a better loss, and ends after
/// `stop_after` such steps in a row.
class Plateau {
 public:
  Plateau(double rate, double factor, int patience, int stop_after, double tolerance)
      : rate_(rate), factor_(factor), tolerance_(tolerance), patience_(patience), stop_after_(stop_after) {}
  /// Takes the loss of this step; true when it is the best so far.
  bool improved(double loss);
  double rate() const { return rate_; }
  bool over() const { return since_best_ >= stop_after_; }

 private:
  double rate_, factor_, tolerance_, best_ = 1e300, threshold_ = 1e300;
  int patience_, stop_after_, since_best_ = 0, since_change_ = 0;
};

/// The paper's schedule (IV.C): divided by 10 after 10 steps that improve nothing by the usual share (1e-4)
/// of the loss. The paper ends after 100 such steps; at the 50th the rate is 1e-7, which moves no pose by
/// more than 1e-5 degrees, and later ones still less.
inline Plateau paper_plateau() { return Plateau(1e-2, 0.1, 10, 50, 1e-4); }

struct DescendedPose {
  Pose view_from_template;
  double loss = 0;
  int evaluations = 0;
};

/// One view's pose under a fixed template.
DescendedPose descend_pose(const Autoencoder& model, const LatentView& view, bool planar,
                           const Eigen::Matrix3Xf& template_points, const Pose& start,
                           const LatentOptions& options, int most_evaluations);

/// Poses of all views under one template, with L_i of each.
struct PosedViews {
  std::vector<Pose> view_from_template;
  std::vector<double> loss;
};

struct JointState : PosedViews {
  Eigen::VectorXf z;  // the template's latent vector
  double total = 0;   // the losses' sum plus lambda R(z)
};

/// Template and poses together, in place; ends with the best state met. Returns the number of steps.
int descend_jointly(const Autoencoder& model, const LatentViews& views, const LatentOptions& options,
                    int most_steps, Progress& progress, JointState& state);

/// Gauss-Newton step (w, v) of a pose under relative damping, within the trust of the linearisation; planar:
/// a turn about z and a shift in the plane.
Eigen::Matrix<double, 6, 1> damped_step(const LossTerm& term, double damping, bool planar);

}  // namespace polar
