#include "drawn_points.hpp"

#include <algorithm>

#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"

namespace polar::pipeline {

namespace {
constexpr std::size_t kDrawn = 4000;  // localisations
}

smlm::LocalisationTable drawn_points(const Eigen::Matrix3Xd& x_nm, const Eigen::VectorXd& weight,
                                     double width_nm, const smlm::LocalisationTable& like) {
  std::vector<double> variance;
  for (const auto& c : like.covariance_nm2)
    variance.push_back(
        static_cast<double>(like.planar ? std::min(c[0], c[3]) : std::min({c[0], c[3], c[5]})));
  const auto wide = static_cast<float>(quantile(std::move(variance), 0.5) + width_nm * width_nm);
  smlm::LocalisationTable table;
  table.planar = like.planar;
  table.particle_names = {"model"};
  double before = 0;
  Eigen::Index k = 0;
  for (std::size_t i = 0; i < kDrawn; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(kDrawn);
    while (k + 1 < weight.size() && before + weight[k] < share) before += weight[k++];
    table.position_nm.push_back({x_nm(0, k), x_nm(1, k), like.planar ? 0 : x_nm(2, k)});
    table.covariance_nm2.push_back(isotropic_covariance(wide));
    table.particle.push_back(0);
  }
  return table;
}

}  // namespace polar::pipeline
