#include "polar/fusion/polish.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "fusion_data_impl.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "pose_terms.hpp"
#include "view_likelihood.hpp"

namespace polar {

namespace {

constexpr int kResponsibilityRounds = 2;
constexpr int kIterations = 8;
constexpr int kLastSteps = 4;  // evaluations on the exact likelihood
constexpr int kPoseParameters = 6;
constexpr double kDifference = 1e-4;  // step of the second derivative, rad and particle radii

// Residuals of all terms of one view; parameters are the step (w, v) from a reference pose.
class ViewResiduals : public ceres::CostFunction {
 public:
  ViewResiduals(const std::vector<Term>& terms, const Pose& reference)
      : terms_(terms), reference_(reference) {
    set_num_residuals(static_cast<int>(3 * terms.size()));
    mutable_parameter_block_sizes()->push_back(6);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Vector6> step(parameters[0]);
    const Eigen::Vector3d w = step.head<3>();
    const Eigen::Matrix3d turn = so3_exp(w);
    const Eigen::Matrix3d left = left_jacobian(w);
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      const Term& term = terms_[i];
      const Eigen::Vector3d turned =
          turn * (term.moves ? reference_ * term.centre : reference_.rotation * term.centre);
      const auto row = static_cast<Eigen::Index>(3 * i);
      const Eigen::Vector3d shift = term.moves ? Eigen::Vector3d(step.tail<3>()) : Eigen::Vector3d::Zero();
      Eigen::Map<Eigen::Vector3d>(residuals + row) = term.root * (turned + shift - term.x);
      if (!jacobians || !jacobians[0]) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> j(jacobians[0], num_residuals(),
                                                                              6);
      j.block<3, 3>(row, 0) = -term.root * cross_matrix(turned) * left;
      if (term.moves)
        j.block<3, 3>(row, 3) = term.root;
      else
        j.block<3, 3>(row, 3).setZero();
    }
    return true;
  }

 private:
  // d exp(w) x = -[exp(w) x]_x J_l(w) dw (T. D. Barfoot, State Estimation for Robotics, 2017, eq. 7.77).
  static Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& w) {
    const double a = w.norm();
    const Eigen::Matrix3d k = cross_matrix(w);
    if (a < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * k + k * k / 6.0;
    return Eigen::Matrix3d::Identity() + (1 - std::cos(a)) / (a * a) * k +
           (a - std::sin(a)) / (a * a * a) * k * k;
  }

  const std::vector<Term>& terms_;
  Pose reference_;
};

Pose least_squares(const std::vector<Term>& terms, const Pose& start, bool planar) {
  double step[6] = {0, 0, 0, 0, 0, 0};
  ceres::Problem problem;
  problem.AddParameterBlock(step, 6, planar ? new ceres::SubsetManifold(6, {0, 1, 5}) : nullptr);
  problem.AddResidualBlock(new ViewResiduals(terms, start), nullptr, step);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = kIterations;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() ? perturbed(start, Eigen::Map<Vector6>(step)) : start;
}

// Second derivative of the log likelihood by central differences of the analytic gradient.
Matrix6 observed_information(ViewFrame& frame, const KernelLocalisations& view, const Pose& at,
                             float background, const float* weight) {
  Matrix6 h;
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = kDifference * Vector6::Unit(i);
    const Vector6 up = pose_derivatives(frame, view, perturbed(at, step), background, weight).gradient;
    const Vector6 down = pose_derivatives(frame, view, perturbed(at, -step), background, weight).gradient;
    h.col(i) = (down - up) / (2 * kDifference);
  }
  return 0.5 * (h + h.transpose());
}

// Inverse on the free parameters; zero for those that planar data does not have.
Matrix6 inverse_information(const Matrix6& information, bool planar, bool& positive) {
  std::vector<int> free = planar ? std::vector<int>{2, 3, 4} : std::vector<int>{0, 1, 2, 3, 4, 5};
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd part(n, n);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b)
      part(a, b) = information(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(part);
  const double largest = eigen.eigenvalues().maxCoeff();
  positive = largest > 0 && eigen.eigenvalues().minCoeff() > 1e-9 * largest;
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().cwiseMax(1e-9 * std::max(largest, 1e-12)).cwiseInverse();
  const Eigen::MatrixXd c = eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
  Matrix6 out = Matrix6::Zero();
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b)
      out(free[static_cast<std::size_t>(a)], free[static_cast<std::size_t>(b)]) = c(a, b);
  return out;
}

// Sum over bursts of the outer product of their gradients, and how many bursts.
struct BurstSpread {
  Matrix6 sum = Matrix6::Zero();
  int bursts = 0;
};
BurstSpread spread_of_bursts(ViewFrame& frame, const KernelLocalisations& view, const std::vector<int>& burst,
                             const Pose& at, float background, const float* weight) {
  std::map<int, KernelLocalisations> members;  // in the order of their numbers
  BurstSpread out;
  const auto add = [&](const KernelLocalisations& some) {
    const Vector6 g = pose_derivatives(frame, some, at, background, weight).gradient;
    out.sum += g * g.transpose();
    ++out.bursts;
  };
  for (std::size_t j = 0; j < view.size(); ++j)
    if (burst[j] >= 0)
      members[burst[j]].push_back(view[j]);
    else
      add({view[j]});
  for (const auto& [number, some] : members) add(some);
  return out;
}

// A step (w, v) after view_from_template, seen after template_from_view (first order).
Matrix6 adjoint(const Pose& template_from_view) {
  Matrix6 a = Matrix6::Zero();
  a.topLeftCorner<3, 3>() = a.bottomRightCorner<3, 3>() = template_from_view.rotation;
  a.bottomLeftCorner<3, 3>() = cross_matrix(template_from_view.translation) * template_from_view.rotation;
  return a;
}

// view_from_template: least squares for responsibilities renewed, then uphill on the exact likelihood.
RefinedPose highest(ViewFrame& frame, const KernelLocalisations& view, const Mixture& mixture, Pose pose,
                    float background, bool planar, const float* weight) {
  double best = log_likelihood(frame, view, pose, background, weight);
  const std::vector<Eigen::Matrix3d> roots = roots_of(view);
  for (int round = 0; round < kResponsibilityRounds; ++round) {
    const std::vector<Term> terms = terms_at(mixture, frame.at(pose, weight), background, view, roots);
    if (terms.size() < 3) break;
    const Pose next = least_squares(terms, pose, planar);
    const double there = log_likelihood(frame, view, next, background, weight);
    if (!(there > best)) break;
    best = there, pose = next;
  }
  return refine_pose(frame, view, pose, background, planar, kLastSteps, weight);
}

}  // namespace

std::vector<Pose> polished_poses(const Mixture& mixture, const FusionData& data,
                                 const std::vector<Pose>& poses) {
  const BlockedMixture blocked(mixture);
  std::vector<Pose> out = poses;
  parallel_for(data.size(), [&](std::size_t i) {
    const KernelLocalisations& view = data.impl().view[i];
    if (view.empty()) return;
    ViewFrame frame(blocked);
    std::vector<float> buffer;
    const float* weight = view_weight(data, i, blocked.weight(), buffer);
    out[i] = highest(frame, view, mixture, poses[i].inverse(), blocked.background(), data.planar(), weight)
                 .view_from_template.inverse();
  });
  return out;
}

std::vector<PolishedPose> polish(const Mixture& mixture, const FusionData& data,
                                 const std::vector<Pose>& poses, const std::vector<std::vector<int>>& burst) {
  const BlockedMixture blocked(mixture);
  const float background = blocked.background();
  std::vector<PolishedPose> out(data.size());
  parallel_for(data.size(), [&](std::size_t i) {
    const KernelLocalisations& view = data.impl().view[i];
    PolishedPose& result = out[i];
    result.template_from_view = poses[i];
    if (view.empty()) return;
    ViewFrame frame(blocked);
    std::vector<float> buffer;
    const float* weight = view_weight(data, i, blocked.weight(), buffer);
    const RefinedPose refined =
        highest(frame, view, mixture, poses[i].inverse(), background, data.planar(), weight);
    const Pose& pose = refined.view_from_template;
    result.template_from_view = pose.inverse();
    result.log_likelihood = refined.log_likelihood / static_cast<double>(view.size());
    bool positive = false;
    Matrix6 covariance = inverse_information(observed_information(frame, view, pose, background, weight),
                                             data.planar(), positive);
    if (!positive) {
      covariance = inverse_information(pose_derivatives(frame, view, pose, background, weight).fisher,
                                       data.planar(), positive);
    }
    if (!burst.empty() && burst[i].size() == view.size()) {
      const BurstSpread spread = spread_of_bursts(frame, view, burst[i], pose, background, weight);
      if (spread.bursts > kPoseParameters) {
        const double share = (covariance * spread.sum).trace() / (data.planar() ? 3 : kPoseParameters);
        result.temper = 1 / std::max(1.0, share);
        const Matrix6 robust = covariance * spread.sum * covariance;
        if (robust.trace() > covariance.trace()) covariance = robust;
      }
    }
    const Matrix6 a = adjoint(result.template_from_view);
    result.covariance = a * covariance * a.transpose();
    result.outlier_fraction = outlier_share(frame, view, pose, background, weight);
  });
  return out;
}

}  // namespace polar
