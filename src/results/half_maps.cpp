#include "polar/results/half_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "polar/core/median.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kNoiseStage = 0x83;
constexpr double kHeld = 0.99;      // share of the localisations that decides the cube's size
constexpr double kMargin = 1.15;    // of the cube's half edge over their radius
constexpr double kReach = 4;        // standard deviations that the renderer draws
constexpr double kSoftening = 0.6;  // voxels added to what is drawn: nothing falls between two voxels
constexpr std::size_t kMostVoxels = 192, kMostPlanarVoxels = 1024, kFewestVoxels = 32;

using Table = smlm::LocalisationTable;

double sigma_nm(const smlm::Covariance& c, bool planar, bool largest) {
  const float variance = planar ? (largest ? std::max(c[0], c[3]) : std::min(c[0], c[3]))
                                : (largest ? std::max({c[0], c[3], c[5]}) : std::min({c[0], c[3], c[5]}));
  return std::sqrt(static_cast<double>(variance));
}

// The number of voxels along an edge, a product of 2, 3 and 5: what the transform is fast for.
std::size_t smooth_number(std::size_t least) {
  for (std::size_t n = least + least % 2;; n += 2) {
    std::size_t rest = n;
    for (const std::size_t factor : {2u, 3u, 5u})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}

// The cube that both tables are drawn in.
Volume cube(const Table& a, const Table& b, std::size_t most_voxels) {
  const bool planar = a.planar;
  Eigen::Vector3d centre;
  std::vector<double> radius, sigma;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> along;
    for (const Table* t : {&a, &b})
      for (const auto& x : t->position_nm) along.push_back(x[static_cast<std::size_t>(axis)]);
    centre[axis] = planar && axis == 2 ? 0.0 : quantile(std::move(along), 0.5);
  }
  for (const Table* t : {&a, &b})
    for (std::size_t i = 0; i < t->size(); ++i) {
      const auto& x = t->position_nm[i];
      radius.push_back((Eigen::Vector3d(x[0], x[1], planar ? 0.0 : x[2]) - centre).norm());
      sigma.push_back(sigma_nm(t->covariance_nm2[i], planar, false));
    }
  const double fine_nm = quantile(std::move(sigma), 0.5);
  const double edge_nm = 2 * (kMargin * quantile(std::move(radius), kHeld) + kReach * fine_nm);
  const double wished = 2 * edge_nm / std::max(fine_nm, 1e-3 * edge_nm);
  const std::size_t most = most_voxels > 0 ? most_voxels : planar ? kMostPlanarVoxels : kMostVoxels;
  const std::size_t n =
      smooth_number(std::clamp(static_cast<std::size_t>(std::ceil(wished)), kFewestVoxels, most));
  Volume v;
  v.planar = planar;
  v.size = {n, n, planar ? 1 : n};
  v.voxel_nm = edge_nm / static_cast<double>(n);
  for (std::size_t axis = 0; axis < (planar ? 2u : 3u); ++axis)
    v.origin_nm[axis] = centre[static_cast<Eigen::Index>(axis)] - v.voxel_nm * static_cast<double>(n - 1) / 2;
  return v;
}

// Draws what does not reach the cube's faces.
Volume drawn_inside(const Table& table, Volume grid, RenderOptions options) {
  options.lateral_extra_nm = std::hypot(options.lateral_extra_nm, kSoftening * grid.voxel_nm);
  options.axial_extra_nm = std::hypot(options.axial_extra_nm, kSoftening * grid.voxel_nm);
  std::vector<bool> inside(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double factor = std::max(options.lateral_factor, options.axial_factor);
    const double extra = std::max(options.lateral_extra_nm, options.axial_extra_nm);
    const double reach_nm =
        kReach * std::hypot(factor * sigma_nm(table.covariance_nm2[i], table.planar, true), extra);
    bool fits = true;
    for (std::size_t axis = 0; axis < (table.planar ? 2u : 3u); ++axis) {
      const double low = grid.origin_nm[axis],
                   high = low + grid.voxel_nm * static_cast<double>(grid.size[axis] - 1);
      fits = fits && table.position_nm[i][axis] - reach_nm >= low &&
             table.position_nm[i][axis] + reach_nm <= high;
    }
    inside[i] = fits;
  }
  return render_into(std::move(grid), rows_to_draw(table, inside), options);
}
}  // namespace

bool ResolutionReport::supported() const {
  const double found = data.resolution.period_nm, control = noise.resolution.period_nm;
  return std::isfinite(found) && !(control <= found);
}

DrawnShells shells_between(const Table& a, const RenderOptions& drawing_a, const Table& b,
                           const RenderOptions& drawing_b, std::size_t most_voxels) {
  if (a.size() == 0 || b.size() == 0) return {};
  const Volume grid = cube(a, b, most_voxels);
  DrawnShells out{grid.voxel_nm, drawn_inside(a, grid, drawing_a), drawn_inside(b, grid, drawing_b), {}};
  out.shells = fourier_shells(out.first, out.second);
  return out;
}

Projections projections_of(const Volume& v) {
  Projections p;
  p.edge = v.size[0];
  constexpr std::array<std::array<std::size_t, 3>, 3> kAcrossUpThrough = {{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};
  const auto depth_nm = static_cast<float>(v.planar ? 1.0 : v.voxel_nm);
  for (std::size_t plane = 0; plane < (v.planar ? 1u : 3u); ++plane) {
    const auto [across, up, through] = kAcrossUpThrough[plane];
    std::array<std::size_t, 3> at{};
    for (at[up] = 0; at[up] < p.edge; ++at[up])
      for (at[across] = 0; at[across] < p.edge; ++at[across]) {
        double sum = 0;
        for (at[through] = 0; at[through] < v.size[through]; ++at[through])
          sum += double(v.at(at[0], at[1], at[2]));
        p.value.push_back(depth_nm * static_cast<float>(sum));
      }
  }
  return p;
}

HalfMaps compare_half_maps(const Results& first, const Results& second, std::uint64_t seed,
                           const Results* whole) {
  HalfMaps out;
  out.first_particles = accepted_particles(first), out.second_particles = accepted_particles(second);
  if (out.first_particles == 0 || out.second_particles == 0) return out;
  out.first_from_second_nm = align_maps(first, second, seed);
  const Pose drawn_from_first = whole != nullptr ? align_maps(*whole, first, seed) : Pose{};
  const Table a = moved(superparticle(first), drawn_from_first),
              b = moved(superparticle(second), drawn_from_first * out.first_from_second_nm);
  const auto drawing = [](const Results& r) {
    return calibrated_rendering(r.registration.calibration, r.normalisation.scale_nm);
  };
  DrawnShells drawn = shells_between(a, drawing(first), b, drawing(second));
  out.voxel_nm = drawn.voxel_nm;
  out.first_density = std::move(drawn.first), out.second_density = std::move(drawn.second);
  if (!out.first_density.density.empty()) {
    out.first_projections = projections_of(out.first_density);
    out.second_projections = projections_of(out.second_density);
  }
  out.shells = std::move(drawn.shells);
  out.resolution = shell_resolution(out.shells);
  return out;
}

smlm::ParticleSet noise_particles(smlm::ParticleSet set, std::uint64_t seed) {
  const std::size_t axes = set.table.planar ? 2 : 3;
  for (std::size_t p = 0; p < set.particles.size(); ++p) {
    const std::vector<std::uint32_t>& rows = set.particles[p].rows;
    if (rows.empty()) continue;
    std::array<double, 3> mean{};
    for (const std::uint32_t row : rows)
      for (std::size_t a = 0; a < axes; ++a)
        mean[a] += set.table.position_nm[row][a] / static_cast<double>(rows.size());
    double square = 0;
    for (const std::uint32_t row : rows)
      for (std::size_t a = 0; a < axes; ++a) square += std::pow(set.table.position_nm[row][a] - mean[a], 2);
    const double width_nm = std::sqrt(square / static_cast<double>(axes * rows.size()));
    KeyedRandom random(seed, p, kNoiseStage);
    for (const std::uint32_t row : rows)
      for (std::size_t a = 0; a < axes; ++a)
        set.table.position_nm[row][a] = mean[a] + width_nm * random.normal();
  }
  return set;
}

}  // namespace polar
