#include "smlm/row_filter.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "smlm/error.hpp"
#include "smlm/kept_column.hpp"
#include "smlm/number_text.hpp"
#include "table_rows.hpp"

namespace smlm {
namespace {

using Value = std::function<double(std::size_t)>;

// Of what every table has; empty for other keys.
Value built_in(const LocalisationTable& table, const std::string& key) {
  const auto position = [&](std::size_t axis) {
    return [&table, axis](std::size_t row) { return table.position_nm[row][axis]; };
  };
  const auto sigma = [&](std::size_t element) {
    return [&table, element](std::size_t row) {
      return std::sqrt(static_cast<double>(table.covariance_nm2[row][element]));
    };
  };
  if (key == "x_nm") return position(0);
  if (key == "y_nm") return position(1);
  if (key == "z_nm" && !table.planar) return position(2);
  if (key == "sigma_x_nm") return sigma(0);
  if (key == "sigma_y_nm") return sigma(3);
  if (key == "sigma_z_nm" && !table.planar) return sigma(5);
  if (key == "sigma_xy_nm")
    return [&table](std::size_t row) { return lateral_sigma_nm(table.covariance_nm2[row]); };
  return {};
}

Value value_of(const LocalisationTable& table, const std::string& key) {
  if (Value value = built_in(table, key)) return value;
  const ExtraColumn* column = find_named_column(table, key);
  if (column != nullptr && column->labels.empty())
    return [column](std::size_t row) { return column->values[row]; };
  std::string known = "x_nm, y_nm, z_nm, sigma_x_nm, sigma_y_nm, sigma_xy_nm, sigma_z_nm";
  for (const ExtraColumn& c : table.extra)
    if (c.labels.empty()) known += ", " + c.name;
  throw Error(Fault::input, table.files.empty() ? "input.filters" : table.files.front(),
              column != nullptr ? "column '" + key + "' of input.filters holds text"
                                : "has no column '" + key + "', which input.filters names",
              "filter by one of " + known);
}

}  // namespace

void filter_rows(LocalisationTable& table, const std::map<std::string, Bounds>& filters) {
  if (filters.empty()) return;
  std::vector<std::uint32_t> kept(table.size());
  std::iota(kept.begin(), kept.end(), 0U);
  for (const auto& [key, bounds] : filters) {
    const Value value = value_of(table, key);
    const double low = bounds[0];
    const double high = bounds[1];
    std::array<Rejection, 3> rejected{};
    rejected[0].reason = key + " below " + number_text(low);
    rejected[1].reason = key + " above " + number_text(high);
    rejected[2].reason = key + " is no number";
    const auto outside = [&](std::uint32_t row) {
      const double v = value(row);
      if (v >= low && v <= high) return false;
      Rejection& r = rejected[v < low ? 0 : v > high ? 1 : 2];
      if (r.rows++ == 0) r.first_row = table.source_row[row];
      return true;
    };
    kept.erase(std::remove_if(kept.begin(), kept.end(), outside), kept.end());
    for (Rejection& r : rejected)
      if (r.rows > 0) table.rejected.push_back(std::move(r));
  }
  take_rows(table, kept);
}

}  // namespace smlm
