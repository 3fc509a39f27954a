#include "known_column.hpp"

#include <cmath>

#include "smlm/column.hpp"

namespace polar::results {

const smlm::ExtraColumn* find_length_nm(const smlm::LocalisationTable& table, const char* name) {
  for (const smlm::ExtraColumn& column : table.extra) {
    const smlm::Heading heading = smlm::parse_heading(column.name);
    const std::string& unit = heading.unit.empty() ? column.unit : heading.unit;
    if (column.labels.empty() && heading.name == name && unit == "nm") return &column;
  }
  return nullptr;
}

double value_or(const smlm::ExtraColumn* column, std::size_t row, double otherwise) {
  const double value = column ? column->values[row] : otherwise;
  return std::isfinite(value) && value >= 0 ? value : otherwise;
}

}  // namespace polar::results
