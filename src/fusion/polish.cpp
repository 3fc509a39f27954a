#include "polar/fusion/polish.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fusion_data_impl.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "view_likelihood.hpp"

namespace polar {

namespace {

constexpr int kResponsibilityRounds = 2;
constexpr int kIterations = 8;
constexpr float kLeastResponsibility = 1e-3f;  // of a centre for a localisation to keep the pair
constexpr double kDifference = 1e-4;           // step of the second derivative, rad and particle radii

struct Pair {
  Eigen::Vector3d centre;  // template frame
  Eigen::Vector3d x;       // localisation, frame of the view
  Eigen::Matrix3d root;    // sqrt(r) C^(-1/2): root^T root = r C^-1
};

// Pairs of localisation and centre with their responsibility at a pose.
std::vector<Pair> pairs_at(const Mixture& m, const std::vector<float>& visibility,
                           const KernelLocalisations& view, const Pose& view_from_template) {
  std::vector<Pair> pairs;
  Eigen::ArrayXf weight(m.size());
  Eigen::Matrix3Xf moved(3, m.size()), difference(3, m.size());
  Eigen::ArrayXf prior = m.weight.array() * static_cast<float>(1 - m.outlier_fraction);
  if (!visibility.empty()) prior *= Eigen::Map<const Eigen::ArrayXf>(visibility.data(), m.size());
  const Eigen::Matrix3f r = view_from_template.rotation.cast<float>();
  moved = (r * m.centre).colwise() + view_from_template.translation.cast<float>().eval();
  const auto background = static_cast<float>(m.outlier_fraction * m.outlier_density);
  for (const kernel::Localisation& l : view) {
    Eigen::Matrix3f p;
    p << l.pxx, l.pxy, l.pxz, l.pxy, l.pyy, l.pyz, l.pxz, l.pyz, l.pzz;
    const Eigen::Vector3f x(l.x, l.y, l.z);
    difference = moved.colwise() - x;
    weight = (-0.5f * (difference.array() * (p * difference).array()).colwise().sum().transpose()).exp() *
             prior * l.norm;
    const float total = background + weight.sum();
    // P may be singular (planar): its root by eigenvalues.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(p.cast<double>());
    const Eigen::Matrix3d root =
        eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose();
    for (Eigen::Index k = 0; k < m.size(); ++k) {
      const float responsibility = weight[k] / total;
      if (responsibility > kLeastResponsibility)
        pairs.push_back({m.centre.col(k).cast<double>(), x.cast<double>(),
                         std::sqrt(static_cast<double>(responsibility)) * root});
    }
  }
  return pairs;
}

// Residuals of all pairs of one view; parameters are the step (w, v) from a reference pose.
class ViewResiduals : public ceres::CostFunction {
 public:
  ViewResiduals(const std::vector<Pair>& pairs, const Pose& reference)
      : pairs_(pairs), reference_(reference) {
    set_num_residuals(static_cast<int>(3 * pairs.size()));
    mutable_parameter_block_sizes()->push_back(6);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Vector6> step(parameters[0]);
    const Eigen::Vector3d w = step.head<3>();
    const Eigen::Matrix3d turn = so3_exp(w);
    const Eigen::Matrix3d left = left_jacobian(w);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const Pair& pair = pairs_[i];
      const Eigen::Vector3d turned = turn * (reference_ * pair.centre);
      const auto row = static_cast<Eigen::Index>(3 * i);
      Eigen::Map<Eigen::Vector3d>(residuals + row) = pair.root * (turned + step.tail<3>() - pair.x);
      if (!jacobians || !jacobians[0]) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> j(jacobians[0], num_residuals(),
                                                                              6);
      j.block<3, 3>(row, 0) = -pair.root * cross_matrix(turned) * left;
      j.block<3, 3>(row, 3) = pair.root;
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

  const std::vector<Pair>& pairs_;
  Pose reference_;
};

Pose least_squares(const std::vector<Pair>& pairs, const Pose& start, bool planar) {
  double step[6] = {0, 0, 0, 0, 0, 0};
  ceres::Problem problem;
  problem.AddParameterBlock(step, 6, planar ? new ceres::SubsetManifold(6, {0, 1, 5}) : nullptr);
  problem.AddResidualBlock(new ViewResiduals(pairs, start), nullptr, step);
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

// A step (w, v) after view_from_template, seen after template_from_view (first order).
Matrix6 adjoint(const Pose& template_from_view) {
  Matrix6 a = Matrix6::Zero();
  a.topLeftCorner<3, 3>() = a.bottomRightCorner<3, 3>() = template_from_view.rotation;
  a.bottomLeftCorner<3, 3>() = cross_matrix(template_from_view.translation) * template_from_view.rotation;
  return a;
}

}  // namespace

std::vector<PolishedPose> polish(const Mixture& mixture, const FusionData& data,
                                 const std::vector<Pose>& poses) {
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
    Pose pose = poses[i].inverse();
    double best = log_likelihood(frame, view, pose, background, weight);
    for (int round = 0; round < kResponsibilityRounds; ++round) {
      const std::vector<Pair> pairs = pairs_at(mixture, data.visibility(i), view, pose);
      if (pairs.size() < 3) break;
      const Pose next = least_squares(pairs, pose, data.planar());
      const double there = log_likelihood(frame, view, next, background, weight);
      if (!(there > best)) break;
      best = there, pose = next, result.improved = true;
    }
    const RefinedPose refined = refine_pose(frame, view, pose, background, data.planar(), 4, weight);
    pose = refined.view_from_template;
    result.template_from_view = pose.inverse();
    result.log_likelihood = refined.log_likelihood / static_cast<double>(view.size());
    Matrix6 covariance = inverse_information(observed_information(frame, view, pose, background, weight),
                                             data.planar(), result.information_positive);
    if (!result.information_positive) {
      bool ignored = false;
      covariance = inverse_information(pose_derivatives(frame, view, pose, background, weight).fisher,
                                       data.planar(), ignored);
    }
    const Matrix6 a = adjoint(result.template_from_view);
    result.covariance = a * covariance * a.transpose();
    result.outlier_fraction = outlier_share(frame, view, pose, background, weight);
  });
  return out;
}

}  // namespace polar
