#include "table_rows.hpp"

#include <cmath>

namespace smlm {
namespace {

template <class T>
void take(std::vector<T>& values, const std::vector<std::uint32_t>& rows) {
  std::vector<T> taken;
  taken.reserve(rows.size());
  for (const std::uint32_t row : rows) taken.push_back(values[row]);
  values = std::move(taken);
}

}  // namespace

void take_rows(LocalisationTable& table, const std::vector<std::uint32_t>& rows) {
  take(table.position_nm, rows);
  take(table.covariance_nm2, rows);
  take(table.particle, rows);
  take(table.source_file, rows);
  take(table.source_row, rows);
  for (ExtraColumn& column : table.extra) take(column.values, rows);
}

double lateral_sigma_nm(const Covariance& c) {
  return std::sqrt((static_cast<double>(c[0]) + static_cast<double>(c[3])) / 2);
}

}  // namespace smlm
