#include <algorithm>

#include "descent.hpp"
#include "polar/core/parallel.hpp"
#include "polar/latent/density.hpp"
#include "polar/latent/template.hpp"

namespace polar {

namespace {

constexpr std::size_t kBlock = 4;  // views a task
constexpr double kRate = 1e-2;     // of z at first
constexpr double kDecay = 1e-2;    // AdamW's usual weight decay, of z; a pose has no origin to decay to
// Second-order poses settle in a few steps, so z need not wait as long for its plateau as in the paper.
constexpr double kFactor = 0.3, kTolerance = 1e-3;
constexpr int kPatience = 4, kStopAfter = 12;
constexpr double kPaperViews = 100;
constexpr double kWorse = 1.05;  // a view's loss may rise so much, because the template moves too
constexpr double kFirstDamping = 1e-1, kLeastDamping = 1e-3, kMostDamping = 1e3;

using Vector6d = Eigen::Matrix<double, 6, 1>;

// How one view's pose moves, from step to step.
struct PoseStepper {
  AdamW adam{6};
  double damping = kFirstDamping, last_loss = 1e300;
  Pose last;
};

// Levenberg-Marquardt across steps: a pose that made its view worse goes back and is damped more.
Pose marquardt_step(PoseStepper& s, const LossTerm& term, const Pose& pose, bool planar) {
  if (term.loss > kWorse * s.last_loss && s.damping < kMostDamping) {
    s.damping *= 8;
    s.last_loss = 1e300;
    return s.last;
  }
  s.damping = std::max(kLeastDamping, s.damping / 3);
  s.last_loss = term.loss;
  s.last = pose;
  return stepped(pose, damped_step(term, s.damping, planar));
}

Pose adam_step(PoseStepper& s, const LossTerm& term, const Pose& pose, double rate, bool planar) {
  Vector6d gradient = 2 * (term.jacobian.transpose() * term.residual).cast<double>();
  if (planar) gradient[0] = gradient[1] = gradient[5] = 0;
  return stepped(pose, s.adam.step(gradient, rate));
}

}  // namespace

int descend_jointly(const Autoencoder& model, const LatentViews& views, const LatentOptions& options,
                    int most_steps, Progress& progress, JointState& state) {
  const bool paper = options.optimizer == "adamw";
  const std::size_t n = views.view.size();
  Plateau plateau = paper ? paper_plateau() : Plateau(kRate, kFactor, kPatience, kStopAfter, kTolerance);
  // The loss is a sum over views, and the paper's lambda stands beside 100 of them.
  const double lambda = options.regularisation * static_cast<double>(n) / kPaperViews;
  AdamW adam(state.z.size());
  std::vector<PoseStepper> stepper(n);
  JointState now = state, best;
  best.total = 1e300;
  now.loss.assign(n, 0);
  int step = 0;
  for (; step < most_steps && !plateau.over() && (step == 0 || !progress.cancelled()); ++step) {
    const Eigen::Matrix3Xf points = template_points(model, now.z, views.planar);
    std::vector<LossTerm> term(n);
    Eigen::MatrixXf gradient = ordered_sum<Eigen::MatrixXf>(
        n, kBlock, Eigen::MatrixXf::Zero(3, points.cols()), [&](std::size_t begin, std::size_t end) {
          Eigen::MatrixXf sum = Eigen::MatrixXf::Zero(3, points.cols());
          for (std::size_t i = begin; i < end; ++i) {
            term[i] =
                view_loss(model, views.view[i], points, now.view_from_template[i], Derive::pose_and_template);
            sum += term[i].template_gradient;
            term[i].template_gradient.resize(3, 0);
          }
          return sum;
        });
    Eigen::Matrix3Xf even;
    now.total = 0;
    if (lambda > 0) {
      now.total = lambda * density_spread(points, options.regularisation_radius, &even);
      gradient += static_cast<float>(lambda) * even;
    }
    for (std::size_t i = 0; i < n; ++i) now.total += now.loss[i] = term[i].loss;
    if (plateau.improved(now.total)) best = now;
    const double rate = plateau.rate();
    parallel_for(n, [&](std::size_t i) {
      if (views.view[i].empty()) return;
      Pose& pose = now.view_from_template[i];
      pose = paper ? adam_step(stepper[i], term[i], pose, rate, views.planar)
                   : marquardt_step(stepper[i], term[i], pose, views.planar);
    });
    if (views.planar) gradient.row(2).setZero();
    now.z *= static_cast<float>(1 - rate * kDecay);
    now.z += adam.step(model.decode_gradient(now.z, gradient).cast<double>(), rate).cast<float>();
  }
  state = std::move(best);
  return step;
}

}  // namespace polar
