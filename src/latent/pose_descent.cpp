#include <algorithm>
#include <cmath>

#include "descent.hpp"

namespace polar {

namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8;  // of Adam, the usual ones
constexpr double kFirstDamping = 1e-2, kMostDamping = 1e3;
constexpr double kLongestTurn = 0.4, kLongestShift = 0.25;  // rad, radii: where linearising is trusted
constexpr double kGain = 1e-3;  // relative: a step that gains less ends Levenberg-Marquardt

Vector6d free_part(Vector6d v, bool planar) {
  if (planar) v[0] = v[1] = v[5] = 0;
  return v;
}

DescendedPose levenberg_marquardt(const Autoencoder& model, const LatentView& view, bool planar,
                                  const Eigen::Matrix3Xf& points, const Pose& start, int most) {
  LossTerm term = view_loss(model, view, points, start, Derive::pose);
  DescendedPose best{start, term.loss, 1};
  double damping = kFirstDamping;
  while (best.evaluations < most && damping < kMostDamping) {
    const Pose trial = stepped(best.view_from_template, damped_step(term, damping, planar));
    LossTerm there = view_loss(model, view, points, trial, Derive::pose);
    ++best.evaluations;
    if (!(there.loss < best.loss)) {
      damping *= 8;
      continue;
    }
    const bool small = best.loss - there.loss < kGain * best.loss;
    best.view_from_template = trial;
    best.loss = there.loss;
    term = std::move(there);
    damping = std::max(1e-6, damping / 4);
    if (small) break;
  }
  return best;
}

DescendedPose adamw(const Autoencoder& model, const LatentView& view, bool planar,
                    const Eigen::Matrix3Xf& points, const Pose& start, int most) {
  DescendedPose best{start, 1e300, 0};
  Pose pose = start;
  AdamW adam(6);
  Plateau plateau = paper_plateau();
  while (best.evaluations < most && !plateau.over()) {
    const LossTerm term = view_loss(model, view, points, pose, Derive::pose);
    ++best.evaluations;
    if (plateau.improved(term.loss)) best.view_from_template = pose, best.loss = term.loss;
    const Vector6d gradient = 2 * (term.jacobian.transpose() * term.residual).cast<double>();
    pose = stepped(pose, adam.step(free_part(gradient, planar), plateau.rate()));
  }
  return best;
}

}  // namespace

Eigen::VectorXd AdamW::step(const Eigen::VectorXd& gradient, double rate) {
  ++steps_;
  first_ = kBeta1 * first_ + (1 - kBeta1) * gradient;
  second_ = kBeta2 * second_ + (1 - kBeta2) * gradient.cwiseAbs2();
  const double c1 = 1 - std::pow(kBeta1, steps_), c2 = 1 - std::pow(kBeta2, steps_);
  return (-rate / c1 * first_.array() / ((second_.array() / c2).sqrt() + kEpsilon)).matrix();
}

bool Plateau::improved(double loss) {
  const bool best = loss < best_;
  if (best) best_ = loss;
  if (loss < threshold_) {
    threshold_ = loss * (1 - tolerance_);
    since_best_ = since_change_ = 0;
    return best;
  }
  ++since_best_;
  if (++since_change_ >= patience_) rate_ *= factor_, since_change_ = 0;
  return best;
}

Vector6d damped_step(const LossTerm& term, double damping, bool planar) {
  Eigen::Matrix<double, 6, 6> a = (term.jacobian.transpose() * term.jacobian).cast<double>();
  const Vector6d b = free_part((term.jacobian.transpose() * term.residual).cast<double>(), planar);
  if (planar)
    for (const int k : {0, 1, 5}) {
      a.row(k).setZero();
      a.col(k).setZero();
      a(k, k) = 1;
    }
  a.diagonal() *= 1 + damping;
  a.diagonal().array() += 1e-9 * a.diagonal().maxCoeff();
  Vector6d step = -a.ldlt().solve(b);
  if (!step.allFinite()) return Vector6d::Zero();
  return step * std::min({1.0, kLongestTurn / std::max(1e-12, step.head<3>().norm()),
                          kLongestShift / std::max(1e-12, step.tail<3>().norm())});
}

DescendedPose descend_pose(const Autoencoder& model, const LatentView& view, bool planar,
                           const Eigen::Matrix3Xf& points, const Pose& start, const LatentOptions& options,
                           int most_evaluations) {
  if (view.empty()) return {start, 0, 0};
  return options.optimizer == "adamw"
             ? adamw(model, view, planar, points, start, most_evaluations)
             : levenberg_marquardt(model, view, planar, points, start, most_evaluations);
}

}  // namespace polar
