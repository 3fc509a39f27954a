#include "polar/registration/prepare.hpp"

#include <algorithm>
#include <cmath>

#include "smlm/error.hpp"

namespace polar {

namespace {

// Point of least summed distance (E. Weiszfeld, Tohoku Mathematical Journal 43, 1937): half of the
// localisations may be strays before it leaves the structure.
Eigen::Vector3d geometric_median(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kIterations = 30;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  if (points.empty()) return centre;
  for (const Eigen::Vector3d& x : points) centre += x / static_cast<double>(points.size());
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0;
    for (const Eigen::Vector3d& x : points) {
      const double w = 1 / std::max(1e-9, (x - centre).norm());
      sum += w * x, weight += w;
    }
    centre = sum / weight;
  }
  return centre;
}

double quantile(std::vector<double> v, double q) {
  if (v.empty()) return 0;
  const auto at = std::min(v.size() - 1, static_cast<std::size_t>(q * static_cast<double>(v.size())));
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(at), v.end());
  return v[at];
}

}  // namespace

Views prepare_views(const smlm::ParticleSet& particles, const PrepareOptions& options) {
  const smlm::LocalisationTable& table = particles.table;
  Views views;
  views.planar = table.planar;
  std::vector<double> radii;
  for (const smlm::Particle& particle : particles.particles) {
    std::vector<Eigen::Vector3d> positions;
    for (const std::uint32_t row : particle.rows)
      positions.emplace_back(table.position_nm[row][0], table.position_nm[row][1], table.position_nm[row][2]);
    const Eigen::Vector3d centre = geometric_median(positions);
    View view;
    view.points.resize(3, static_cast<Eigen::Index>(particle.rows.size()));
    std::vector<double> distance;
    for (std::size_t j = 0; j < particle.rows.size(); ++j) {
      const Eigen::Vector3d x = positions[j] - centre;  // in double: fields are large
      view.points.col(static_cast<Eigen::Index>(j)) = x.cast<float>();
      view.covariance.push_back(table.covariance_nm2[particle.rows[j]]);
      distance.push_back(x.norm());
    }
    if (!distance.empty()) radii.push_back(options.radius_factor * quantile(std::move(distance), 0.5));
    views.view.push_back(std::move(view));
    views.normalisation.centre_nm.push_back(centre);
  }
  const double scale = quantile(std::move(radii), 0.5);
  if (!(scale > 0))
    throw smlm::Error(smlm::Fault::input, "particles", "all localisations of a particle coincide",
                      "check the particle column and the coordinates' unit");
  views.normalisation.scale_nm = scale;
  const auto shrink = static_cast<float>(1 / scale);
  for (View& view : views.view) {
    view.points *= shrink;
    for (Symmetric3& c : view.covariance)
      for (float& v : c) v *= shrink * shrink;
  }
  return views;
}

}  // namespace polar
