#include "emitter.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"

namespace polar::results {

namespace {
constexpr double kReach = 6;  // standard deviations from a site, beyond which nothing belongs to it

template <int D>
Emitter emitter(const Eigen::Matrix3d& c3, const Eigen::Vector3d& x3, const Site& s) {
  using Matrix = Eigen::Matrix<double, D, D>;
  using Vector = Eigen::Matrix<double, D, 1>;
  const Matrix c = c3.topLeftCorner<D, D>();
  const double w2 = s.width_nm * s.width_nm;
  if ((x3 - s.centre_nm).template head<D>().squaredNorm() > kReach * kReach * (c.trace() + w2)) return {};
  const Matrix total = c + w2 * Matrix::Identity(), inverse = total.inverse();
  const Vector mu = s.centre_nm.head<D>(), d = x3.head<D>() - mu, pull = inverse * d;
  Emitter e;
  e.density = std::exp(-0.5 * d.dot(pull)) / std::sqrt(std::pow(2 * kPi, D) * total.determinant());
  e.mean.head<D>() = mu + w2 * pull;
  e.variance = D * w2 - w2 * w2 * inverse.trace();
  return e;
}
}  // namespace

double sigma_nm(const smlm::LocalisationTable& table, std::size_t row) {
  const smlm::Covariance& c = table.covariance_nm2[row];
  return std::sqrt(table.planar ? double(c[0] + c[3]) / 2 : double(c[0] + c[3] + c[5]) / 3);
}

std::vector<std::vector<std::size_t>> rows_of_particles(const smlm::LocalisationTable& table) {
  std::vector<std::vector<std::size_t>> rows(table.particle_names.size());
  for (std::size_t row = 0; row < table.size(); ++row)
    if (table.particle[row] >= 0) rows[static_cast<std::size_t>(table.particle[row])].push_back(row);
  rows.erase(std::remove_if(rows.begin(), rows.end(), [](const auto& own) { return own.empty(); }),
             rows.end());
  return rows;
}

Emitter emitter(bool planar, const Eigen::Matrix3d& covariance, const Eigen::Vector3d& x, const Site& site) {
  return planar ? emitter<2>(covariance, x, site) : emitter<3>(covariance, x, site);
}

}  // namespace polar::results
