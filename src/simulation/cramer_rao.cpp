#include "polar/simulation/cramer_rao.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kFisherStage = 0x51, kPairStage = 0x52;
constexpr double kUndetermined =
    1e-12;  // of the largest eigenvalue: double precision's floor for a sum of squares

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix3d widened(const smlm::Covariance& c, const StructureModel& model) {
  Eigen::Matrix3d m = matrix(c);
  m.diagonal().array() += model.label_size_nm * model.label_size_nm;
  if (model.planar) {  // z is decoupled and carries nothing
    m.row(2).setZero();
    m.col(2).setZero();
    m(2, 2) = 1;
  }
  return m;
}

// d log p / d (w, v) at x, for sites already moved into the table's frame.
Vector6d score(const StructureModel& model, const Eigen::Matrix3d& rotation, const Eigen::Matrix3Xd& mean_nm,
               const Eigen::Matrix3d& precision, double log_norm, const Eigen::Vector3d& x) {
  const double log_weight =
      std::log((1 - model.outlier_fraction) / static_cast<double>(mean_nm.cols())) + log_norm;
  double density = model.outlier_fraction * model.outlier_density;
  Vector6d sum = Vector6d::Zero();
  for (Eigen::Index k = 0; k < mean_nm.cols(); ++k) {
    const Eigen::Vector3d residual = x - mean_nm.col(k);
    const Eigen::Vector3d pull = precision * residual;
    const double p = std::exp(log_weight - 0.5 * residual.dot(pull));
    // The site moves by R^T (s x w - v) in the table's frame when the pose is perturbed by (w, v).
    const Eigen::Vector3d u = rotation * pull;
    sum.head<3>() += p * u.cross(model.site_nm.col(k));
    sum.tail<3>() -= p * u;
    density += p;
  }
  return density > 0 ? Vector6d(sum / density) : Vector6d(Vector6d::Zero());
}
}  // namespace

Matrix6d fisher_information(const StructureModel& model, const Pose& structure_from_view,
                            const std::vector<smlm::Covariance>& covariance_nm2, int draws,
                            std::uint64_t seed, std::uint64_t item) {
  KeyedRandom random(seed, item, kFisherStage);
  const Pose view_from_structure = structure_from_view.inverse();
  Eigen::Matrix3Xd mean_nm = view_from_structure.rotation * model.site_nm;
  mean_nm.colwise() += view_from_structure.translation;
  if (model.planar) mean_nm.row(2).setZero();
  Matrix6d information = Matrix6d::Zero();
  if (mean_nm.cols() == 0) return information;
  for (const smlm::Covariance& c : covariance_nm2) {
    const Eigen::Matrix3d covariance = widened(c, model);
    const Eigen::LLT<Eigen::Matrix3d> root(covariance);
    const Eigen::Matrix3d precision = covariance.inverse();
    const double log_norm =
        -0.5 * (model.planar ? 2.0 : 3.0) * std::log(kTwoPi) - 0.5 * std::log(covariance.determinant());
    for (int d = 0; d < draws; ++d) {
      // An outlier's place carries no pull worth integrating: its draws are counted with score 0.
      if (random.uniform() < model.outlier_fraction) continue;
      const auto k = static_cast<Eigen::Index>(random.below(static_cast<std::uint64_t>(mean_nm.cols())));
      Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
      if (model.planar) noise.z() = 0;
      const Eigen::Vector3d x = mean_nm.col(k) + root.matrixL() * noise;
      const Vector6d s = score(model, structure_from_view.rotation, mean_nm, precision, log_norm, x);
      information += s * s.transpose() / draws;
    }
  }
  return information;
}

Matrix6d cramer_rao_bound(const Matrix6d& information, bool planar) {
  if (planar) {  // free: rotation about z, shifts along x and y
    const Eigen::Vector3i free(2, 3, 4);
    Eigen::Matrix3d small;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) small(i, j) = information(free[i], free[j]);
    Matrix6d embedded = Matrix6d::Identity();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) embedded(free[i], free[j]) = small(i, j);
    Matrix6d bound = cramer_rao_bound(embedded, false);
    for (const int i : {0, 1, 5}) bound(i, i) = 0;
    return bound;
  }
  // Rotations and shifts have different units; scaling to a unit diagonal makes the threshold meaningful.
  Vector6d scale;
  for (int i = 0; i < 6; ++i) scale[i] = information(i, i) > 0 ? 1.0 / std::sqrt(information(i, i)) : 0.0;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scale.asDiagonal() * information * scale.asDiagonal());
  const double largest = eigen.eigenvalues().maxCoeff();
  if (!(eigen.eigenvalues().minCoeff() > kUndetermined * largest))
    return Matrix6d(Vector6d::Constant(std::numeric_limits<double>::infinity()).asDiagonal());
  const Matrix6d inverse = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                           eigen.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

double pair_median_deg(const std::vector<Matrix6d>& bound, std::uint64_t seed) {
  constexpr std::size_t kDraws = 20000;  // the median's own error is then below 1 %
  if (bound.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  KeyedRandom random(seed, 0, kPairStage);
  const auto error = [&](const Matrix6d& covariance) -> Eigen::Matrix3d {
    if (!covariance.topLeftCorner<3, 3>().allFinite()) return random.rotation();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance.topLeftCorner<3, 3>());
    const Eigen::Vector3d n(random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d deviation = eigen.eigenvalues().cwiseMax(0).cwiseSqrt();
    return so3_exp(eigen.eigenvectors() * deviation.cwiseProduct(n));
  };
  std::vector<double> angle(kDraws);
  for (double& a : angle) {
    const std::size_t i = random.below(bound.size());
    const std::size_t j = (i + 1 + random.below(bound.size() - 1)) % bound.size();
    const Eigen::Matrix3d first = error(bound[i]);
    a = geodesic_angle(first, error(bound[j]));
  }
  std::nth_element(angle.begin(), angle.begin() + kDraws / 2, angle.end());
  return angle[kDraws / 2] * 360 / kTwoPi;
}

}  // namespace polar
