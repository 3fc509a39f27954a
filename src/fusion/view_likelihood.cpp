#include "view_likelihood.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "mixture_kernel_choice.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {

constexpr int kBatch = 256;  // localisations whose moments fit the first-level cache
constexpr double kFirstDamping = 0.1;
constexpr double kLargestDamping = 1e6;
constexpr double kConverged = 1e-5;  // step in radians and particle radii: a hundredth of any real accuracy

// Score of one localisation: d ln p / d(w, v). Moments are sums over centres of density-weighted 1, mu, mu
// mu^T.
Vector6 score(const kernel::Localisation& l, const kernel::Moments& m, float background, Matrix6& majorant) {
  Eigen::Matrix3f p, s;
  p << l.pxx, l.pxy, l.pxz, l.pxy, l.pyy, l.pyz, l.pxz, l.pyz, l.pzz;
  s << m.sxx, m.sxy, m.sxz, m.sxy, m.syy, m.syz, m.sxz, m.syz, m.szz;
  const Eigen::Vector3f x(l.x, l.y, l.z), mu(m.mx, m.my, m.mz);
  const Eigen::Matrix3f sp = s * p;
  const Eigen::Vector3f mu_cross_p_mu(sp(1, 2) - sp(2, 1), sp(2, 0) - sp(0, 2), sp(0, 1) - sp(1, 0));
  const float scale = 1.0f / (m.density + background);
  Vector6 g;
  g.head<3>() = (scale * (mu.cross(p * x) - mu_cross_p_mu)).cast<double>();
  g.tail<3>() = (scale * (p * (m.density * x - mu))).cast<double>();
  if (m.density > 0) {
    Eigen::Matrix<float, 3, 6> j;  // d mu' / d(w, v) at the mean centre
    const Eigen::Vector3f c = mu / m.density;
    j << 0, c.z(), -c.y(), 1, 0, 0, -c.z(), 0, c.x(), 0, 1, 0, c.y(), -c.x(), 0, 0, 0, 1;
    majorant += (scale * m.density * (j.transpose() * p * j)).cast<double>();
  }
  return g;
}

// sum_j f(density of localisation j)
template <typename F>
double sum_over(const kernel::Centres& centres, const KernelLocalisations& view, F f) {
  float density[kBatch];
  double total = 0;
  for (std::size_t begin = 0; begin < view.size(); begin += kBatch) {
    const int n = static_cast<int>(std::min<std::size_t>(kBatch, view.size() - begin));
    mixture_kernel().density(centres, view.data() + begin, n, density);
    for (int j = 0; j < n; ++j) total += f(density[j]);
  }
  return total;
}

void keep_in_plane(PoseDerivatives& d) {
  for (const int i : {0, 1, 5}) {
    d.gradient[i] = 0;
    for (Matrix6* m : {&d.fisher, &d.majorant}) {
      m->row(i).setZero();
      m->col(i).setZero();
      (*m)(i, i) = 1;
    }
  }
}

}  // namespace

double log_likelihood(ViewFrame& frame, const KernelLocalisations& view, const Pose& pose, float background,
                      const float* weight) {
  return sum_over(frame.at(pose, weight), view,
                  [&](float density) { return std::log(static_cast<double>(density + background)); });
}

double outlier_share(ViewFrame& frame, const KernelLocalisations& view, const Pose& pose, float background,
                     const float* weight) {
  if (view.empty()) return 0;
  return sum_over(frame.at(pose, weight), view,
                  [&](float density) { return static_cast<double>(background / (density + background)); }) /
         static_cast<double>(view.size());
}

PoseDerivatives pose_derivatives(ViewFrame& frame, const KernelLocalisations& view, const Pose& pose,
                                 float background, const float* weight) {
  const kernel::Centres& centres = frame.at(pose, weight);
  kernel::Moments moments[kBatch];
  PoseDerivatives d;
  for (std::size_t begin = 0; begin < view.size(); begin += kBatch) {
    const int n = static_cast<int>(std::min<std::size_t>(kBatch, view.size() - begin));
    mixture_kernel().moments(centres, view.data() + begin, n, moments);
    for (int j = 0; j < n; ++j) {
      const Vector6 g = score(view[begin + static_cast<std::size_t>(j)], moments[j], background, d.majorant);
      d.log_likelihood += std::log(static_cast<double>(moments[j].density + background));
      d.gradient += g;
      d.fisher.noalias() += g * g.transpose();
    }
  }
  return d;
}

Pose perturbed(const Pose& pose, const Vector6& step) {
  return Pose{so3_exp(step.head<3>()), step.tail<3>()} * pose;
}

RefinedPose refine_pose(ViewFrame& frame, const KernelLocalisations& view, const Pose& start,
                        float background, bool planar, int max_evaluations, const float* weight) {
  const auto derivatives = [&](const Pose& pose) {
    return pose_derivatives(frame, view, pose, background, weight);
  };
  RefinedPose best{start, 0, 1};
  PoseDerivatives at = derivatives(start);
  if (planar) keep_in_plane(at);
  best.log_likelihood = at.log_likelihood;
  double damping = kFirstDamping;
  while (best.evaluations < max_evaluations && damping < kLargestDamping) {
    Matrix6 h = at.fisher + damping * at.majorant;
    h.diagonal().array() += 1e-9 * (1.0 + h.diagonal().array());
    const Vector6 step = h.ldlt().solve(at.gradient);
    if (!step.allFinite()) break;
    if (step.norm() < kConverged) break;
    const Pose next = perturbed(best.view_from_template, step);
    PoseDerivatives there = derivatives(next);
    ++best.evaluations;
    if (there.log_likelihood > best.log_likelihood) {
      if (planar) keep_in_plane(there);
      best.view_from_template = next;
      best.log_likelihood = there.log_likelihood;
      at = there;
      damping = std::max(1e-3, damping * 0.3);
    } else {
      damping *= 5;
    }
  }
  return best;
}

}  // namespace polar
