#include "polar/registration/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "evenness.hpp"
#include "polar/core/parallel.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {

// Point of least summed weighted distance (E. Weiszfeld, Tohoku Mathematical Journal 43, 1937): half of the
// weight may be strays before it leaves the structure.
Eigen::Vector3d geometric_median(const Eigen::Matrix3Xd& points, const std::vector<double>& weights) {
  constexpr int kIterations = 30;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  if (points.cols() == 0) return centre;
  centre = points.rowwise().mean();
  for (int i = 0; i < kIterations; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 0;
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      const double w = weights[static_cast<std::size_t>(j)] / std::max(1e-9, (points.col(j) - centre).norm());
      sum += w * points.col(j), weight += w;
    }
    centre = sum / weight;
  }
  return centre;
}

// The value below which half of the weight lies, 0 where there is none.
double median(const std::vector<double>& value, const std::vector<double>& weight) {
  std::vector<std::size_t> order(value.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return value[a] < value[b]; });
  double left = 0.5 * std::accumulate(weight.begin(), weight.end(), 0.0);
  for (const std::size_t i : order)
    if ((left -= weight[i]) <= 0) return value[i];
  return 0;
}

struct Extent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

Extent extent(const Eigen::Matrix3Xd& points, const std::vector<double>& weight, double radius_factor) {
  Extent e{geometric_median(points, weight), 0};
  const Eigen::VectorXd distance = (points.colwise() - e.centre).colwise().norm().transpose();
  e.radius = radius_factor * median({distance.begin(), distance.end()}, weight);
  return e;
}

// Half of all particles that have an extent are larger.
double typical_radius(const std::vector<Extent>& extents) {
  std::vector<double> radii;
  for (const Extent& e : extents)
    if (e.radius > 0) radii.push_back(e.radius);
  const std::vector<double> equal(radii.size(), 1.0);
  return median(radii, equal);
}

}  // namespace

Views prepare_views(const smlm::ParticleSet& particles, const PrepareOptions& options) {
  const smlm::LocalisationTable& table = particles.table;
  const std::size_t n = particles.particles.size();
  Views views;
  views.planar = table.planar;
  std::vector<Eigen::Matrix3Xd> positions(n);
  std::vector<Extent> extents(n);
  parallel_for(n, [&](std::size_t i) {
    const auto& rows = particles.particles[i].rows;
    positions[i].resize(3, static_cast<Eigen::Index>(rows.size()));
    for (std::size_t j = 0; j < rows.size(); ++j)
      positions[i].col(static_cast<Eigen::Index>(j)) =
          Eigen::Map<const Eigen::Vector3d>(table.position_nm[rows[j]].data());
    extents[i] = extent(positions[i], std::vector<double>(rows.size(), 1.0), options.radius_factor);
  });
  // Twice: what is dense can only be said once the size of a particle is known.
  const double first_scale = typical_radius(extents);
  parallel_for(n, [&](std::size_t i) {
    const Eigen::Matrix3Xf about_centre = (positions[i].colwise() - extents[i].centre).cast<float>();
    extents[i] =
        extent(positions[i], even_weights(about_centre, kEvennessReach * first_scale), options.radius_factor);
  });
  const double scale = typical_radius(extents);
  if (!(scale > 0))
    throw smlm::Error(smlm::Fault::input, "particles", "all localisations of a particle coincide",
                      "check the particle column and the coordinates' unit");
  views.normalisation.scale_nm = scale;
  const auto shrink = static_cast<float>(1 / scale);
  for (std::size_t i = 0; i < n; ++i) {
    View view;
    view.points = (positions[i].colwise() - extents[i].centre).cast<float>() * shrink;
    for (const std::uint32_t row : particles.particles[i].rows) {
      view.covariance.push_back(table.covariance_nm2[row]);
      for (float& v : view.covariance.back()) v *= shrink * shrink;
    }
    views.normalisation.centre_nm.push_back(extents[i].centre);
    views.view.push_back(std::move(view));
  }
  return views;
}

}  // namespace polar
