#include "smlm/read_options.hpp"

#include <set>

#include "smlm/column.hpp"
#include "smlm/table_reader.hpp"
#include "smlm/units.hpp"

namespace smlm {
namespace {

void check_word(std::vector<std::string>& faults, const std::string& key, const std::string& value,
                const std::vector<std::string>& allowed) {
  std::string list;
  for (const std::string& word : allowed) {
    if (word == value) return;
    if (!word.empty()) list += (list.empty() ? "" : ", ") + word;
  }
  faults.push_back(key + ": '" + value + "' is not one of " + list);
}

std::string quantities() {
  std::set<std::string> seen;
  std::string list;
  for (const ColumnSpec& spec : column_registry()) {
    if (seen.insert(std::string(spec.name)).second)
      list += (list.empty() ? "" : ", ") + std::string(spec.name);
  }
  return list;
}

}  // namespace

std::vector<std::string> violations(const ReadOptions& options) {
  std::vector<std::string> faults;
  std::vector<std::string> formats{"auto"};
  for (const TableReader& reader : table_readers()) formats.emplace_back(reader.name);
  check_word(faults, "format", options.format, formats);
  check_word(faults, "particles", options.particles, {"column", "one_per_file", "picked"});
  if (options.particles == "picked" && !(options.pick.radius_nm > 0 && options.pick.radius_nm <= 1e9)) {
    faults.emplace_back("pick.radius_nm: must be positive where particles are picked");
  }
  check_word(faults, "lpz_unit", options.lpz_unit, {"nm", "px"});
  check_word(faults, "sigma_kind", options.sigma_kind, {"", "std", "variance"});
  for (const auto& [key, bounds] : options.filters)
    if (!(bounds[0] <= bounds[1]))
      faults.push_back("filters." + key + ": the low bound is above the high one");
  for (const std::string& fault : violations(options.group)) faults.push_back("group." + fault);
  for (const std::string& fault : violations(options.channel)) faults.push_back("channel." + fault);
  if (options.channel.per_file && options.particles != "column" && options.pick.centres.empty())
    faults.emplace_back(
        "channel.per_file: the files have no particles in common; name a particle column, or "
        "pick.centres");
  for (const std::string& fault : violations(options.particle_limits))
    faults.push_back("particle_limits." + fault);
  if (!options.unit.empty() && !units::parse_length(options.unit)) {
    faults.push_back("unit: '" + options.unit + "' is not a length (nm, um, mm, m, px, angstrom)");
  }
  if (!(options.pixel_size_nm >= 0 && options.pixel_size_nm < 1e6)) {
    faults.emplace_back("pixel_size_nm: must be positive, or 0 for what the file says");
  }
  if (!(options.assumed_sigma_nm > 0 && options.assumed_sigma_nm < 1e6)) {
    faults.emplace_back("assumed_sigma_nm: must be positive");
  }
  if (!(options.minflux_z_factor > 0 && options.minflux_z_factor <= 10)) {
    faults.emplace_back("minflux_z_factor: must be positive");
  }
  for (const auto& [key, mapping] : options.columns) {
    const std::string where = "columns." + key;
    if (!quantity_named(key)) faults.push_back(where + ": is not one of " + quantities());
    if (mapping.name.empty()) faults.push_back(where + ".name: must not be empty");
    check_word(faults, where + ".kind", mapping.kind, {"", "std", "variance"});
    if (!mapping.unit.empty() && !units::parse_length(units::without_square(mapping.unit))) {
      faults.push_back(where + ".unit: '" + mapping.unit + "' is not a length (nm, um, mm, m, px, angstrom)");
    }
  }
  return faults;
}

}  // namespace smlm
