#include "background.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "polar/core/constants.hpp"

namespace polar::results {

namespace {
constexpr double kFewest = 10;  // localisations of which a volume is made

// Of a D-dimensional even ellipsoid with that covariance: its variance along an axis is axis^2 / (D + 2).
template <int D>
double volume(const Eigen::Matrix3d& covariance) {
  const double unit_ball = D == 2 ? kPi : 4 * kPi / 3;
  return unit_ball * std::pow(D + 2, D / 2.0) * std::sqrt(covariance.topLeftCorner<D, D>().determinant());
}
}  // namespace

double background_density(const smlm::LocalisationTable& t, const std::function<double(std::size_t)>& belongs,
                          double otherwise) {
  double weight = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
  for (std::size_t row = 0; row < t.size(); ++row) {
    const double p = belongs(row);
    const Eigen::Vector3d x(t.position_nm[row].data());
    weight += p, sum += p * x, square += p * x * x.transpose();
  }
  if (weight < kFewest) return otherwise;
  const Eigen::Vector3d mean = sum / weight;
  const Eigen::Matrix3d covariance = square / weight - mean * mean.transpose();
  const double filled = t.planar ? volume<2>(covariance) : volume<3>(covariance);
  return filled > 0 ? 1 / filled : otherwise;
}

}  // namespace polar::results
