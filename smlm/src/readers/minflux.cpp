#include "minflux.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "smlm/number_text.hpp"

namespace smlm::readers {
namespace {

constexpr std::size_t fewest_for_a_spread = 5;

struct Moments {
  std::size_t n = 0;
  std::array<double, 3> mean{}, square{};  // Welford's sums
  void add(const std::array<double, 3>& x) {
    ++n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = x[axis] - mean[axis];
      mean[axis] += step / static_cast<double>(n);
      square[axis] += step * (x[axis] - mean[axis]);
    }
  }
  double deviation(std::size_t axis) const { return std::sqrt(square[axis] / static_cast<double>(n - 1)); }
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

LocalisationTable build_minflux_table(const std::string& path, MinfluxRows rows, const ReadOptions& options) {
  for (auto& location : rows.location_m) {
    for (double& value : location) value *= units::m;
    location[2] *= options.minflux_z_factor;
  }
  std::unordered_map<double, Moments> traces;
  for (std::size_t i = 0; i < rows.trace.size(); ++i) {
    const auto& x = rows.location_m[i];
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) traces[rows.trace[i]].add(x);
  }
  // In the order of the rows, so that nothing depends on how the map is laid out.
  std::array<std::vector<double>, 3> spreads;
  std::unordered_map<double, bool> seen;
  for (const double trace : rows.trace) {
    if (!seen.emplace(trace, true).second || traces[trace].n < fewest_for_a_spread) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) spreads[axis].push_back(traces[trace].deviation(axis));
  }
  const bool measured = !spreads[0].empty() && median(spreads[0]) > 0 && median(spreads[1]) > 0;

  constexpr std::array position_names{"loc_x", "loc_y", "loc_z"};
  constexpr std::array sigma_names{"std_x in trace", "std_y in trace", "std_z in trace"};
  std::vector<ColumnArray> arrays;
  const std::size_t axes = rows.planar ? 2 : 3;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    ColumnArray position{{position_names[axis], "nm", static_cast<Quantity>(axis)}, {}};
    for (const auto& location : rows.location_m) position.values.push_back(location[axis]);
    arrays.push_back(std::move(position));
    if (!measured) continue;
    const double typical = median(spreads[axis]);
    if (axis == 2 && !(typical > 0)) continue;  // two-dimensional measurements have z = 0
    const auto quantity = static_cast<Quantity>(static_cast<std::size_t>(Quantity::sigma_x) + axis);
    ColumnArray sigma{{sigma_names[axis], "nm", quantity}, {}};
    for (const double trace : rows.trace) {
      const Moments& moments = traces[trace];
      const double own = moments.n < fewest_for_a_spread ? 0 : moments.deviation(axis);
      sigma.values.push_back(own > 0 ? own : typical);
    }
    arrays.push_back(std::move(sigma));
  }
  arrays.push_back({{"tid", "", Quantity::other}, std::move(rows.trace)});
  for (ColumnArray& extra : rows.extra) arrays.push_back(std::move(extra));

  LocalisationTable table = build_table(path, path, std::move(arrays), options, std::move(rows.row));
  if (rows.invalid > 0)
    table.rejected.push_back({"marked invalid (vld)", rows.invalid, 0, rows.first_invalid});
  if (!table.planar) {
    table.keys_used.insert("minflux_z_factor");
    if (options.minflux_z_factor != 1)
      table.warnings.push_back(
          "MINFLUX z is multiplied by " + number_text(options.minflux_z_factor) +
          " for the refractive index mismatch (input.minflux_z_factor; 1 keeps it as measured)");
  }
  if (measured)
    table.warnings.push_back("MINFLUX files hold no uncertainty: the spread within each trace is taken");
  return table;
}

}  // namespace smlm::readers
