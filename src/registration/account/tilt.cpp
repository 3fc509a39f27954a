#include "polar/registration/tilt.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/median.hpp"

namespace polar {

namespace {
// Median of the sum of two squared standard normal numbers: a tilt has two axes.
constexpr double kMedianSquare = 1.3862943611198906;
}  // namespace

std::optional<TiltSpread> tilt_spread(const std::vector<RegisteredView>& view) {
  Eigen::Matrix3d lines = Eigen::Matrix3d::Zero();
  std::size_t accepted = 0;
  for (const RegisteredView& v : view) {
    if (!v.accepted) continue;
    const Eigen::Vector3d z = v.template_from_view.rotation.col(2);
    lines += z * z.transpose();
    ++accepted;
  }
  if (accepted == 0) return std::nullopt;
  const Eigen::Vector3d upright = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(lines).eigenvectors().col(2);
  std::vector<double> square, added;
  for (const RegisteredView& v : view) {
    if (!v.accepted) continue;
    const double tilt = std::acos(std::min(1.0, std::abs(v.template_from_view.rotation.col(2).dot(upright))));
    const Eigen::Matrix3d error = v.covariance.topLeftCorner<3, 3>();
    square.push_back(tilt * tilt);
    added.push_back((error.trace() - upright.dot(error * upright)) / 2);
  }
  const double variance = upper_median(std::move(square)) / kMedianSquare - upper_median(std::move(added));
  const double width = std::sqrt(std::max(0.0, variance));
  return TiltSpread{width / kRadiansPerDegree, accepted};
}

}  // namespace polar
