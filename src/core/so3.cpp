#include "polar/core/so3.hpp"

#include <Eigen/SVD>
#include <cmath>

#include "polar/core/constants.hpp"

namespace polar {

namespace {
// Below this angle the Taylor series of sin(a)/a and (1-cos(a))/a^2 to second order is exact in double.
constexpr double kSmallAngle = 1e-4;
}  // namespace

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w) {
  const double a = w.norm();
  const double a2 = a * a;
  const double s = a < kSmallAngle ? 1.0 - a2 / 6.0 : std::sin(a) / a;
  const double c = a < kSmallAngle ? 0.5 - a2 / 24.0 : (1.0 - std::cos(a)) / a2;
  const Eigen::Matrix3d k = cross_matrix(w);
  return Eigen::Matrix3d::Identity() + s * k + c * k * k;
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double n = q.vec().norm();
  if (n < kSmallAngle) return 2.0 * q.vec() / q.w();
  return 2.0 * std::atan2(n, q.w()) / n * q.vec();
}

double geodesic_angle(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  const Eigen::Quaterniond q(Eigen::Matrix3d(a.transpose() * b));
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

Eigen::Quaterniond haar_rotation(double u1, double u2, double u3) {
  const double a = std::sqrt(1.0 - u1), b = std::sqrt(u1);
  return {b * std::cos(2 * kPi * u3), a * std::sin(2 * kPi * u2), a * std::cos(2 * kPi * u2),
          b * std::sin(2 * kPi * u3)};
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d flip = Eigen::Matrix3d::Identity();
  flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixU() * flip * svd.matrixV().transpose();
}

}  // namespace polar
