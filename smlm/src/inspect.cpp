#include "smlm/inspect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "name_index.hpp"

namespace smlm {
namespace {

// PSF widths are 100-150 nm; precisions that large localise nothing.
constexpr double psf_like_sigma_nm = 80;
constexpr double tiny_particle_nm = 1;
constexpr double huge_particle_nm = 1e4;

Summary summarise(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
               values.end());
  if (values.empty()) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double median = *middle;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, median, *most};
}

ColumnSummary summarise_column(const std::string& name, const std::string& unit, bool used,
                               const std::vector<double>& values) {
  ColumnSummary column{name, unit, used, 0, summarise(values)};
  column.values = static_cast<std::uint64_t>(
      std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
  return column;
}

// Standard deviations along one axis; lateral ones are the root mean square of x and y.
std::vector<double> sigmas(const LocalisationTable& table, bool axial) {
  std::vector<double> values;
  values.reserve(table.size());
  for (const Covariance& c : table.covariance_nm2) {
    values.push_back(std::sqrt(axial ? static_cast<double>(c[5])
                                     : (static_cast<double>(c[0]) + static_cast<double>(c[3])) / 2));
  }
  return values;
}

struct ParticleNumbers {
  std::vector<double> localisations, radius_nm;
};

ParticleNumbers measure_particles(const LocalisationTable& table) {
  struct Sums {
    double n = 0;
    std::array<double, 3> mean{};
    double square = 0;
  };
  std::vector<Sums> sums(table.particle_names.size());
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    Sums& s = sums[static_cast<std::size_t>(table.particle[row])];
    s.n += 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = table.position_nm[row][axis] - s.mean[axis];
      s.mean[axis] += step / s.n;
      s.square += step * (table.position_nm[row][axis] - s.mean[axis]);
    }
  }
  ParticleNumbers numbers;
  for (const Sums& s : sums) {
    numbers.localisations.push_back(s.n);
    if (s.n > 1) numbers.radius_nm.push_back(std::sqrt(s.square / s.n));
  }
  return numbers;
}

std::string nm(double value) {
  // Three significant digits say enough.
  if (!(value > 0)) return number_text(value) + " nm";
  const double scale = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return number_text(std::round(value / scale) * scale) + " nm";
}

}  // namespace

std::vector<std::string> implausibilities(const LocalisationTable& table) {
  std::vector<std::string> warnings;
  if (table.size() == 0) return warnings;
  const double lateral = summarise(sigmas(table, false)).median;
  const bool measured = !table.sigma_assumed;
  if (measured && lateral > psf_like_sigma_nm) {
    warnings.push_back("the median lateral uncertainty is " + nm(lateral) +
                       ", as large as the width of a PSF: is it the right column, in the right unit?");
  }
  const ParticleNumbers particles = measure_particles(table);
  if (particles.radius_nm.empty()) return warnings;
  const double radius = summarise(particles.radius_nm).median;
  if (lateral > radius) {
    warnings.push_back("the median lateral uncertainty, " + nm(lateral) +
                       ", is larger than the particles, whose radius is " + nm(radius) +
                       (measured ? "" : " (it is assumed: see input.assumed_sigma_nm)"));
  }
  if (radius < tiny_particle_nm || radius > huge_particle_nm) {
    warnings.push_back("the particles' median radius is " + nm(radius) +
                       ": are the positions in another unit? (input.unit)");
  }
  return warnings;
}

Inspection inspect(const LocalisationTable& table) {
  Inspection result;
  result.files = table.files;
  result.formats = table.formats;
  result.localisations = table.size();
  result.unassigned =
      static_cast<std::uint64_t>(std::count(table.particle.begin(), table.particle.end(), -1));
  result.particles = table.particle_names.size();
  const ParticleNumbers particles = measure_particles(table);
  result.localisations_per_particle = summarise(particles.localisations);
  result.particle_radius_nm = summarise(particles.radius_nm);
  const std::vector<double> lateral = sigmas(table, false);
  result.sigma_lateral_nm = summarise(lateral);
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t axis = 0; axis < (table.planar ? 2U : 3U); ++axis) {
    std::vector<double> values;
    values.reserve(table.size());
    for (const auto& position : table.position_nm) values.push_back(position[axis]);
    result.columns.push_back(summarise_column(names[axis], "nm", true, values));
  }
  result.columns.push_back(summarise_column("sigma_xy", "nm", true, lateral));
  const std::vector<double> axial = table.planar ? std::vector<double>{} : sigmas(table, true);
  result.sigma_axial_nm = summarise(axial);
  if (!table.planar) result.columns.push_back(summarise_column("sigma_z", "nm", true, axial));
  for (const ExtraColumn& extra : table.extra) {
    if (extra.labels.empty()) {
      result.columns.push_back(summarise_column(extra.name, extra.unit, false, extra.values));
    } else {
      result.columns.push_back({extra.name, "text", false, extra.values.size(), summarise({})});
    }
  }
  result.planar = table.planar;
  result.axial_sigma_assumed = table.axial_sigma_assumed;
  result.sigma_assumed = table.sigma_assumed;
  result.mapping = table.mapping;
  result.rejected = table.rejected;
  result.warnings = table.warnings;
  return result;
}

}  // namespace smlm
