#include "displacements.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "polar/core/constants.hpp"

namespace polar::fitting {

namespace {
constexpr double kLeastLocalisations = 0.5;
constexpr double kReach2 = 25;      // squared standard deviations: beyond lies a millionth
constexpr double kFlat_nm2 = 1e-6;  // variance along z of planar data, where nothing moves

// Planar data have no z: as if it were known.
Eigen::Matrix3d covariance_of(const FitData& data, std::size_t i) {
  Eigen::Matrix3d c = data.covariance_nm2[i];
  if (data.planar) c.row(2).setZero(), c.col(2).setZero(), c(2, 2) = kFlat_nm2;
  return c;
}
}  // namespace

Sharing share_out(const FitData& data, const Places& places, double background) {
  const Eigen::Index k = places.x_nm.cols();
  Sharing out{Eigen::MatrixXd(k, static_cast<Eigen::Index>(data.size())),
              Eigen::VectorXd(static_cast<Eigen::Index>(data.size()))};
  const double even = background * data.background_density;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (data.planar) axes(2, 2) = 0;
  const double norm = data.planar ? -std::log(kTwoPi) + 0.5 * std::log(kFlat_nm2) : -1.5 * std::log(kTwoPi);
  for (std::size_t i = 0; i < data.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Matrix3d own = covariance_of(data, i);
    for (Eigen::Index j = 0; j < k; ++j) {
      const Eigen::Matrix3d c = own + axes * places.spread_nm2[static_cast<std::size_t>(j)] * axes;
      const Eigen::Vector3d d = axes * (data.x_nm.col(column) - places.x_nm.col(j));
      if (d.squaredNorm() > kReach2 * c.trace()) {  // farther still in standard deviations
        out.responsibility(j, column) = 0;
        continue;
      }
      const Eigen::LLT<Eigen::Matrix3d> root(c);
      out.responsibility(j, column) =
          places.weight[j] * std::exp(norm - root.matrixLLT().diagonal().array().log().sum() -
                                      0.5 * root.matrixL().solve(d).squaredNorm());
    }
    const double total = out.responsibility.col(column).sum() + even;
    out.responsibility.col(column) /= total;
    out.log_density[column] = std::log(total);
  }
  return out;
}

std::vector<Label> labels_of(const FitData& data, const Structure& s, const Sharing& sharing) {
  std::vector<Eigen::Matrix3d> precision(data.size());
  for (std::size_t i = 0; i < data.size(); ++i) precision[i] = covariance_of(data, i).inverse();
  std::vector<Label> labels;
  for (Eigen::Index k = 0; k < s.site_nm.cols(); ++k) {
    Label label;
    label.site = k;
    label.localisations = sharing.responsibility.row(k).sum();
    if (label.localisations < kLeastLocalisations) continue;
    Eigen::Matrix3d total = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < data.size(); ++i) {
      const double r = sharing.responsibility(k, static_cast<Eigen::Index>(i));
      total += r * precision[i];
      sum += r * (precision[i] * (data.x_nm.col(static_cast<Eigen::Index>(i)) - s.site_nm.col(k)));
    }
    label.covariance_nm2 = total.inverse();
    label.displacement_nm = label.covariance_nm2 * sum;
    if (data.planar) label.displacement_nm.z() = 0;
    labels.push_back(label);
  }
  return labels;
}

}  // namespace polar::fitting
