#include "polar/registration/prepare.hpp"

#include <algorithm>
#include <cmath>

#include "smlm/error.hpp"

namespace polar {

namespace {

double trimmed_mean(std::vector<double> v, double trim) {
  if (v.empty()) return 0;
  std::sort(v.begin(), v.end());
  const auto cut = static_cast<std::size_t>(trim * static_cast<double>(v.size()));
  double total = 0;
  for (std::size_t i = cut; i < v.size() - cut; ++i) total += v[i];
  return total / static_cast<double>(v.size() - 2 * cut);
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
    Eigen::Vector3d centre;
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<double> v;
      for (const std::uint32_t row : particle.rows) v.push_back(table.position_nm[row][a]);
      centre[static_cast<Eigen::Index>(a)] = trimmed_mean(std::move(v), options.trim);
    }
    View view;
    view.points.resize(3, static_cast<Eigen::Index>(particle.rows.size()));
    std::vector<double> distance;
    for (std::size_t j = 0; j < particle.rows.size(); ++j) {
      const auto& p = table.position_nm[particle.rows[j]];
      const Eigen::Vector3d x = Eigen::Vector3d(p[0], p[1], p[2]) - centre;  // in double: fields are large
      view.points.col(static_cast<Eigen::Index>(j)) = x.cast<float>();
      view.covariance.push_back(table.covariance_nm2[particle.rows[j]]);
      distance.push_back(x.norm());
    }
    if (!distance.empty()) radii.push_back(quantile(std::move(distance), options.radius_quantile));
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
