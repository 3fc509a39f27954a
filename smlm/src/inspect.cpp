#include "smlm/inspect.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "particle_numbers.hpp"
#include "smlm/particle_set.hpp"

namespace smlm {
namespace {

ColumnSummary summarise_column(const std::string& name, const std::string& unit, bool used,
                               const std::vector<double>& values) {
  ColumnSummary column{name, unit, used, 0, summarise(values)};
  column.values = static_cast<std::uint64_t>(
      std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
  return column;
}

}  // namespace

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
  if (const auto obstacle = obstacle_to_registration(table)) result.obstacle = obstacle->what();
  const std::vector<double> lateral = sigmas_nm(table, false);
  result.sigma_lateral_nm = summarise(lateral);
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t axis = 0; axis < (table.planar ? 2U : 3U); ++axis) {
    std::vector<double> values;
    values.reserve(table.size());
    for (const auto& position : table.position_nm) values.push_back(position[axis]);
    result.columns.push_back(summarise_column(names[axis], "nm", true, values));
  }
  result.columns.push_back(summarise_column("sigma_xy", "nm", true, lateral));
  const std::vector<double> axial = table.planar ? std::vector<double>{} : sigmas_nm(table, true);
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
