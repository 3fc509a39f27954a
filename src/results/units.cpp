#include "polar/results/units.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "background.hpp"
#include "emitter.hpp"
#include "label_counts.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"

namespace polar {

namespace {
constexpr double kApart = 3;        // standard deviations between units
constexpr double kLightest = 1e-4;  // of the template: a centre that weighs less says nothing

struct Unit {
  std::vector<Site> centre;  // share: of the unit
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double spread_nm = 0;  // standard deviation about the mean on each axis, widths included
};

std::vector<Unit> units_of(const TemplateSites& fused, const Eigen::Matrix3Xd& unit_nm, int dimensions) {
  std::vector<Unit> units(static_cast<std::size_t>(unit_nm.cols()));
  for (Eigen::Index k = 0; k < fused.centre_nm.cols(); ++k) {
    if (!(fused.weight[k] > kLightest)) continue;
    Eigen::Index nearest = 0;
    (unit_nm.colwise() - fused.centre_nm.col(k)).colwise().squaredNorm().minCoeff(&nearest);
    Site s;
    s.centre_nm = fused.centre_nm.col(k);
    s.width_nm = fused.width_nm;
    s.share = fused.weight[k];
    units[static_cast<std::size_t>(nearest)].centre.push_back(s);
  }
  for (Unit& u : units) {
    double share = 0, square = 0;
    for (const Site& s : u.centre) share += s.share, u.mean += s.share * s.centre_nm;
    if (!(share > 0)) continue;
    u.mean /= share;
    for (Site& s : u.centre) {
      s.share /= share;
      square += s.share * (s.centre_nm - u.mean).squaredNorm();
    }
    u.spread_nm = std::sqrt(square / dimensions + fused.width_nm * fused.width_nm);
  }
  return units;
}

bool apart(const std::vector<Unit>& units, double sigma_nm) {
  for (std::size_t a = 0; a < units.size(); ++a)
    for (std::size_t b = a + 1; b < units.size(); ++b) {
      const double spread = std::hypot(sigma_nm, std::max(units[a].spread_nm, units[b].spread_nm));
      if ((units[a].mean - units[b].mean).norm() < kApart * spread) return false;
    }
  return true;
}
}  // namespace

UnitOccupancy occupied_units(const smlm::LocalisationTable& t, const TemplateSites& fused,
                             const Eigen::Matrix3Xd& unit_nm, double background, double background_share) {
  UnitOccupancy out;
  out.reason = "the template has no symmetric units";
  if (unit_nm.cols() < 2 || t.size() == 0) return out;
  const std::vector<Unit> units = units_of(fused, unit_nm, t.planar ? 2 : 3);
  out.reason = "a symmetric unit holds nothing of the template";
  if (std::any_of(units.begin(), units.end(), [](const Unit& u) { return u.centre.empty(); })) return out;
  std::vector<double> sigma(t.size());
  for (std::size_t row = 0; row < t.size(); ++row) sigma[row] = results::sigma_nm(t, row);
  out.reason = "its symmetric units are not far enough apart to be told from one another";
  if (!apart(units, upper_median(std::move(sigma)))) return out;
  out.reason.clear();
  const auto density = [&](const Eigen::Matrix3d& c, const Eigen::Vector3d& x, std::size_t u) {
    double sum = 0;
    for (const Site& s : units[u].centre) sum += s.share * results::emitter(t.planar, c, x, s).density;
    return sum;
  };
  const auto stray = [&](std::size_t row) {
    const Eigen::Matrix3d c = matrix(t.covariance_nm2[row]);
    const Eigen::Vector3d x(t.position_nm[row].data());
    double units_density = 0;
    for (std::size_t u = 0; u < units.size(); ++u) units_density += density(c, x, u);
    const double none = background_share * background;
    return none / (none + (1 - background_share) * units_density / static_cast<double>(units.size()));
  };
  out.counts = results::count_labels(results::candidates_of(t, units.size(), density), units.size(),
                                     results::background_density(t, stray, background), background_share);
  return out;
}

}  // namespace polar
