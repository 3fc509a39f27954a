#include "factor_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"

namespace polar::fitting {

namespace {
constexpr int kMostSteps = 40;
constexpr double kStill = 1e-3;  // relative change of the label's variance and of the fields' size in a step
constexpr double kRidge = 1e-3;  // labels' worth of pull on a field towards 0: sites that nobody shows
constexpr double kLeastVariance_nm2 = 0.01;

using Loading = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostFactors>;

Loading loading(const FactorModel& m, Eigen::Index site) {
  Loading b(3, m.field_nm.cols() + 6);
  b << m.field_nm.middleRows<3>(3 * site), m.motion.middleRows<3>(3 * site);
  return b;
}

Eigen::Matrix3d label_precision(const FactorModel& m, const Label& label) {
  return (label.covariance_nm2 + m.variance_nm2 * Eigen::Matrix3d::Identity()).inverse();
}

// Fields to start from: the leading components of the displacements as measured, 0 where there is none.
void start_fields(FactorModel& m, const std::vector<std::vector<Label>>& labels) {
  const Eigen::Index n = m.field_nm.rows(), modes = m.field_nm.cols();
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(labels.size()), n);
  for (std::size_t p = 0; p < labels.size(); ++p)
    for (const Label& label : labels[p]) {
      // Shrunk where it is uncertain.
      const Eigen::Vector3d known =
          m.variance_nm2 * label_precision(m, label) * (label.displacement_nm - m.mean_nm.col(label.site));
      d.row(static_cast<Eigen::Index>(p)).segment<3>(3 * label.site) = known.transpose();
    }
  const Eigen::MatrixXd scatter = d.transpose() * d / double(labels.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(scatter);
  for (Eigen::Index k = 0; k < std::min(modes, n); ++k)  // in ascending order
    m.field_nm.col(k) =
        axes.eigenvectors().col(n - 1 - k) * std::sqrt(std::max(0.0, axes.eigenvalues()[n - 1 - k]));
}

// Sums over particles that one site's mean and fields follow from.
struct SiteSums {
  Eigen::MatrixXd left;  // of vec(W_k, m_k)
  Eigen::VectorXd right;
};

void step(FactorModel& m, const std::vector<std::vector<Label>>& labels) {
  const Eigen::Index sites = m.mean_nm.cols(), modes = m.field_nm.cols(), unknowns = 3 * (modes + 1);
  std::vector<SiteSums> sums(
      static_cast<std::size_t>(sites),
      {kRidge * Eigen::MatrixXd::Identity(unknowns, unknowns), Eigen::VectorXd::Zero(unknowns)});
  double squares = 0, count = 0;
  for (const std::vector<Label>& own : labels) {
    if (own.empty()) continue;
    const Factors f = factors_of(m, own);
    auto z = f.mean;  // with 1 for the mean
    z.resize(modes + 1);
    z << f.mean.head(modes), 1;
    Eigen::MatrixXd zz = z * z.transpose();
    zz.topLeftCorner(modes, modes) += f.covariance.topLeftCorner(modes, modes);
    Eigen::MatrixXd rz = f.mean.tail<6>() * z.transpose();  // E r (z, 1)^T
    rz.leftCols(modes) += f.covariance.bottomLeftCorner(6, modes);
    for (const Label& label : own) {
      const Eigen::Matrix3d precision = label_precision(m, label);
      const auto r = m.motion.middleRows<3>(3 * label.site);
      const Loading target = precision * (label.displacement_nm * z.transpose() - r * rz);
      SiteSums& s = sums[static_cast<std::size_t>(label.site)];
      for (Eigen::Index a = 0; a <= modes; ++a) {
        s.right.segment<3>(3 * a) += target.col(a);
        for (Eigen::Index b = 0; b <= modes; ++b) s.left.block<3, 3>(3 * a, 3 * b) += zz(a, b) * precision;
      }
      // The label's own offset, expected.
      const Loading b = loading(m, label.site);
      const Eigen::Vector3d offset =
          m.variance_nm2 * precision * (label.displacement_nm - m.mean_nm.col(label.site) - b * f.mean);
      const Eigen::Matrix3d pull = m.variance_nm2 * precision;
      squares += offset.squaredNorm() + m.variance_nm2 * (3 - pull.trace()) +
                 (pull * b * f.covariance * b.transpose() * pull.transpose()).trace();
      count += 3;
    }
  }
  for (Eigen::Index k = 0; k < sites; ++k) {
    const SiteSums& s = sums[static_cast<std::size_t>(k)];
    const Eigen::VectorXd w = s.left.ldlt().solve(s.right);
    for (Eigen::Index a = 0; a < modes; ++a) m.field_nm.col(a).segment<3>(3 * k) = w.segment<3>(3 * a);
    m.mean_nm.col(k) = w.tail<3>();
  }
  if (count > 0) m.variance_nm2 = std::max(kLeastVariance_nm2, squares / count);
}

// Scores of variance 1, fields without rigid motions, orthogonal, the largest first.
void standardise(FactorModel& m, const std::vector<std::vector<Label>>& labels) {
  const Eigen::Index modes = m.field_nm.cols();
  if (modes == 0) return;
  Eigen::MatrixXd zz = Eigen::MatrixXd::Zero(modes, modes);
  double n = 0;
  for (const std::vector<Label>& own : labels) {
    if (own.empty()) continue;
    const Factors f = factors_of(m, own);
    zz += f.mean.head(modes) * f.mean.head(modes).transpose() + f.covariance.topLeftCorner(modes, modes);
    ++n;
  }
  if (n > 0) m.field_nm = (m.field_nm * Eigen::MatrixXd((zz / n).llt().matrixL())).eval();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> rigid(m.motion);
  m.field_nm -= m.motion * rigid.solve(m.field_nm);
  const Eigen::MatrixXd gram = m.field_nm.transpose() * m.field_nm;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(gram);
  m.field_nm = (m.field_nm * axes.eigenvectors().rowwise().reverse()).eval();
}
}  // namespace

FactorModel rigid_model(const Eigen::Matrix3Xd& site_nm, int modes, double pose_std_deg, double pose_std_nm,
                        bool planar, double variance_nm2) {
  FactorModel m;
  const Eigen::Index sites = site_nm.cols();
  m.mean_nm = Eigen::Matrix3Xd::Zero(3, sites);
  m.field_nm = Eigen::MatrixXd::Zero(3 * sites, modes);
  m.motion = Eigen::MatrixXd::Zero(3 * sites, 6);
  m.variance_nm2 = variance_nm2;
  const Eigen::Vector3d centre = site_nm.rowwise().mean();
  for (Eigen::Index k = 0; k < sites; ++k) {
    m.motion.block<3, 3>(3 * k, 0) = -cross_matrix(site_nm.col(k) - centre);
    m.motion.block<3, 3>(3 * k, 3).setIdentity();
  }
  if (planar)
    for (const Eigen::Index out_of_plane : {0, 1, 5}) m.motion.col(out_of_plane).setZero();
  const double turn = pose_std_deg * kRadiansPerDegree;
  m.motion_precision.resize(6);
  m.motion_precision << Eigen::Vector3d::Constant(1 / (turn * turn)),
      Eigen::Vector3d::Constant(1 / (pose_std_nm * pose_std_nm));
  return m;
}

Factors factors_of(const FactorModel& m, const std::vector<Label>& labels) {
  const Eigen::Index modes = m.field_nm.cols();
  Factors f;
  auto information = f.covariance;
  information.setIdentity(modes + 6, modes + 6);
  information.diagonal().tail<6>() = m.motion_precision;
  auto sum = f.mean;
  sum.setZero(modes + 6);
  for (const Label& label : labels) {
    const Loading b = loading(m, label.site);
    const Loading weighted = label_precision(m, label) * b;
    information.noalias() += weighted.transpose() * b;
    sum.noalias() += weighted.transpose() * (label.displacement_nm - m.mean_nm.col(label.site));
  }
  f.covariance.setIdentity(modes + 6, modes + 6);
  information.llt().solveInPlace(f.covariance);
  f.mean = f.covariance * sum;
  return f;
}

Eigen::Matrix3Xd displacement_of(const FactorModel& m, const Factors& f) {
  const Eigen::Index modes = m.field_nm.cols();
  const Eigen::VectorXd moved = m.field_nm * f.mean.head(modes) + m.motion * f.mean.tail<6>();
  return m.mean_nm + Eigen::Map<const Eigen::Matrix3Xd>(moved.data(), 3, m.mean_nm.cols());
}

std::vector<Eigen::Matrix3d> spread_of(const FactorModel& m, const Factors& f) {
  std::vector<Eigen::Matrix3d> spread;
  for (Eigen::Index k = 0; k < m.mean_nm.cols(); ++k) {
    const Loading b = loading(m, k);
    spread.push_back(b * f.covariance * b.transpose());
  }
  return spread;
}

void fit_factors(FactorModel& model, const std::vector<std::vector<Label>>& labels) {
  if (model.field_nm.cols() > 0 && model.field_nm.isZero()) start_fields(model, labels);
  const auto size = [&] { return Eigen::Vector2d(model.variance_nm2, model.field_nm.norm()); };
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::Vector2d before = size();
    step(model, labels);
    if (((size() - before).array().abs() <= kStill * before.array()).all()) break;
  }
  standardise(model, labels);
}

}  // namespace polar::fitting
