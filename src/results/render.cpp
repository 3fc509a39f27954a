#include "polar/results/render.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/covariance3.hpp"
#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/fusion/effective.hpp"

namespace polar {

namespace {
constexpr double kReach = 4;        // Mahalanobis radius drawn: beyond lies 1.1e-3 of a Gaussian's mass
constexpr double kLeftOut = 0.001;  // share of localisations that may lie outside the box, on each side
constexpr double kSmallestVoxel_nm = 0.05;
constexpr float kFallbackVariance_nm2 = 1;  // where a table says 0
constexpr std::size_t kSlabDepth = 4;       // slices a block; fixed, so that the order of sums is too

struct Gaussian {
  Eigen::Vector3d mean_nm, reach_nm;
  Eigen::Matrix3d precision;
  float peak;
  float bend, bend16;    // by which the ratio of neighbours along x changes from voxel to voxel, to the 16th
  Eigen::Array4f bends;  // to the 0th, 4th, 8th and 12th
};

double median_sigma_nm(const smlm::LocalisationTable& table) {
  std::vector<double> smallest;
  for (const smlm::Covariance& c : table.covariance_nm2)
    smallest.push_back(std::sqrt(double(table.planar ? std::min(c[0], c[3]) : std::min({c[0], c[3], c[5]}))));
  return quantile(std::move(smallest), 0.5);
}

// Covariance `m` (2 x 2 or 3 x 3) with no standard deviation below `least_nm`. In the table's floats the
// covariance of a localisation that is a million times finer along one axis than along another may not even
// be positive definite.
template <class Matrix>
Matrix widened(const Matrix& m, double least_nm) {
  const Matrix rest = m - least_nm * least_nm * Matrix::Identity();
  if (rest.llt().info() == Eigen::Success) return m;
  const Eigen::SelfAdjointEigenSolver<Matrix> axes(m);
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(least_nm * least_nm).asDiagonal() *
         axes.eigenvectors().transpose();
}

Gaussian gaussian(const smlm::LocalisationTable& table, std::size_t row, double voxel_nm) {
  const auto& x = table.position_nm[row];
  Eigen::Matrix3d m = matrix(table.covariance_nm2[row]);
  for (int axis = 0; axis < 3; ++axis)
    if (!(m(axis, axis) > 0)) m(axis, axis) = double(kFallbackVariance_nm2);
  const double least_nm = voxel_nm / 2;  // finer, and what the voxels hold would depend on where it falls
  double dimensions = 3;
  if (table.planar) {  // the slice's own thickness does not count
    dimensions = 2;
    const Eigen::Matrix2d across = widened<Eigen::Matrix2d>(m.topLeftCorner<2, 2>(), least_nm);
    m.setIdentity();
    m.topLeftCorner<2, 2>() = across;
  } else {
    m = widened(m, least_nm);
  }
  Gaussian g;
  g.mean_nm = {x[0], x[1], table.planar ? 0.0 : x[2]};
  g.reach_nm = kReach * m.diagonal().cwiseSqrt();
  g.precision = m.inverse();
  g.peak = static_cast<float>(std::pow(kTwoPi, -dimensions / 2) / std::sqrt(m.determinant()));
  const double curvature = g.precision(0, 0) * voxel_nm * voxel_nm;
  const auto bend = [&](double power) { return static_cast<float>(std::exp(-power * curvature)); };
  g.bend = bend(1), g.bend16 = bend(16), g.bends = {1.0f, bend(4), bend(8), bend(12)};
  return g;
}

// Chooses box and voxel.
Volume frame(const smlm::LocalisationTable& table, const RenderOptions& o) {
  Volume v;
  v.planar = table.planar;
  std::array<double, 3> low{}, high{};
  const double margin = 2 * median_sigma_nm(table);
  double longest = 0;
  for (std::size_t axis = 0; axis < (table.planar ? 2u : 3u); ++axis) {
    std::vector<double> along(table.size());
    for (std::size_t i = 0; i < along.size(); ++i) along[i] = table.position_nm[i][axis];
    low[axis] = quantile(along, kLeftOut) - margin;
    high[axis] = quantile(std::move(along), 1 - kLeftOut) + margin;
    longest = std::max(longest, high[axis] - low[axis]);
  }
  const double wished = o.voxel_nm > 0 ? o.voxel_nm : median_sigma_nm(table) / 2;
  v.wished_voxel_nm = wished;
  v.voxel_nm = std::max({wished, longest / static_cast<double>(o.most_voxels_per_axis), kSmallestVoxel_nm});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    v.size[axis] =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((high[axis] - low[axis]) / v.voxel_nm)));
    // The grid is centred on the box.
    v.origin_nm[axis] = (low[axis] + high[axis]) / 2 - v.voxel_nm * static_cast<double>(v.size[axis] - 1) / 2;
  }
  return v;
}

// First and one past the last index along an axis within [centre - reach, centre + reach] and [begin, end).
std::pair<std::size_t, std::size_t> span(const Volume& v, std::size_t axis, double centre_nm, double reach_nm,
                                         std::size_t begin, std::size_t end) {
  const double first = (centre_nm - reach_nm - v.origin_nm[axis]) / v.voxel_nm;
  const double last = (centre_nm + reach_nm - v.origin_nm[axis]) / v.voxel_nm + 1;
  // Whole numbers by truncation, which a library call for every row would cost more than the row.
  const auto clamped = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x, static_cast<double>(begin), static_cast<double>(end)));
  };
  const std::size_t below = clamped(first);
  return {below + (static_cast<double>(below) < first && below < end ? 1 : 0), clamped(last)};
}

// One row (fixed dy, dz from the mean): along x the exponent is a parabola about x_nm with height `rest` at
// its top, so its exponential follows from two multiplications; four neighbours go together, each from the
// one four before: r_k = r b^k, hence v_(k+4) / v_k = r^4 b^(4k + 6).
void add_row(Volume& v, const Gaussian& g, double dy, double dz, float* row) {
  const Eigen::Matrix3d& p = g.precision;
  const double slope = p(0, 1) * dy + p(0, 2) * dz;
  const double rest = p(1, 1) * dy * dy + 2 * p(1, 2) * dy * dz + p(2, 2) * dz * dz - slope * slope / p(0, 0);
  if (rest >= kReach * kReach) return;
  const double x_nm = g.mean_nm.x() - slope / p(0, 0);
  const double reach = std::sqrt((kReach * kReach - rest) / p(0, 0));
  const auto [x0, x1] = span(v, 0, x_nm, reach, 0, v.size[0]);
  const double h = v.voxel_nm;
  const double d = v.origin_nm[0] + h * static_cast<double>(x0) - x_nm;
  const float first = g.peak * std::exp(static_cast<float>(-0.5 * (rest + p(0, 0) * d * d)));
  const float ratio = std::exp(static_cast<float>(-p(0, 0) * h * (d + 0.5 * h)));
  const float b = g.bend, r1 = ratio * b, r2 = r1 * b;
  Eigen::Array4f value(first, first * ratio, first * ratio * r1, first * ratio * r1 * r2);
  Eigen::Array4f step = g.bends * (ratio * r1) * (r2 * (r2 * b));
  std::size_t x = x0;
  for (; x + 4 <= x1; x += 4) {
    Eigen::Map<Eigen::Array4f>(row + x) += value;
    value *= step;
    step *= g.bend16;
  }
  for (std::size_t k = 0; x < x1; ++x, ++k) row[x] += value[static_cast<Eigen::Index>(k)];
}

// Adds one Gaussian to the slices [z_begin, z_end).
void add(Volume& v, const Gaussian& g, std::size_t z_begin, std::size_t z_end) {
  const auto height = [&](std::size_t z) { return v.origin_nm[2] + v.voxel_nm * static_cast<double>(z); };
  if (!v.planar && (g.mean_nm.z() + g.reach_nm.z() < height(z_begin) ||
                    g.mean_nm.z() - g.reach_nm.z() > height(z_end - 1)))
    return;
  const auto [z0, z1] =
      v.planar ? std::pair{z_begin, z_end} : span(v, 2, g.mean_nm.z(), g.reach_nm.z(), z_begin, z_end);
  const auto [y0, y1] = span(v, 1, g.mean_nm.y(), g.reach_nm.y(), 0, v.size[1]);
  for (std::size_t z = z0; z < z1; ++z)
    for (std::size_t y = y0; y < y1; ++y) {
      const double dy = v.origin_nm[1] + v.voxel_nm * static_cast<double>(y) - g.mean_nm.y();
      const double dz = v.planar ? 0.0 : v.origin_nm[2] + v.voxel_nm * static_cast<double>(z) - g.mean_nm.z();
      add_row(v, g, dy, dz, &v.density[(z * v.size[1] + y) * v.size[0]]);
    }
}

Volume drawn(Volume v, const smlm::LocalisationTable& table) {
  v.density.assign(v.size[0] * v.size[1] * v.size[2], 0.0f);
  std::vector<Gaussian> gaussians(table.size());
  parallel_for(table.size(), [&](std::size_t i) { gaussians[i] = gaussian(table, i, v.voxel_nm); });
  // Every block owns its slices and adds the localisations in their order.
  parallel_blocks(v.size[2], kSlabDepth, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (const Gaussian& g : gaussians) add(v, g, begin, end);
  });
  return v;
}
}  // namespace

smlm::LocalisationTable calibrated(const smlm::LocalisationTable& stated, const RenderOptions& o) {
  smlm::LocalisationTable table;
  table.position_nm = stated.position_nm;
  table.covariance_nm2 = stated.covariance_nm2;
  table.particle = stated.particle;
  table.particle_names = stated.particle_names;
  table.planar = stated.planar;
  NoiseModel noise{o.lateral_factor, o.axial_factor, o.lateral_extra_nm, o.axial_extra_nm, 0, table.planar};
  std::vector<std::vector<std::size_t>> rows(table.particle_names.size() + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    rows[std::min(rows.size() - 1, static_cast<std::size_t>(table.particle.empty() ? 0 : table.particle[i]))]
        .push_back(i);
  for (const auto& own : rows) {
    View view;
    for (const std::size_t i : own) view.covariance.push_back(table.covariance_nm2[i]);
    const Eigen::Vector3f axis = uncertainty_axis(view, table.planar);
    for (const std::size_t i : own)
      table.covariance_nm2[i] = effective_covariance(table.covariance_nm2[i], axis, noise);
  }
  return table;
}

RenderOptions calibrated_rendering(const Calibration& c, double scale_nm) {
  RenderOptions o;
  o.lateral_factor = c.lateral_factor, o.axial_factor = c.axial_factor;
  o.lateral_extra_nm = scale_nm * c.lateral_extra, o.axial_extra_nm = scale_nm * c.axial_extra;
  return o;
}

Volume render(const smlm::LocalisationTable& stated, const RenderOptions& options) {
  if (stated.size() == 0) return {{1, 1, 1}, {0, 0, 0}, 1, stated.planar, {0.0f}};
  const smlm::LocalisationTable table = calibrated(stated, options);
  return drawn(frame(table, options), table);
}

Volume render_into(Volume grid, const smlm::LocalisationTable& table, const RenderOptions& options) {
  return drawn(std::move(grid), calibrated(table, options));
}

}  // namespace polar
