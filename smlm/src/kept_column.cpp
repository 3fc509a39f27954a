#include "smlm/kept_column.hpp"

namespace smlm {

const ExtraColumn* find_column(const LocalisationTable& table, Quantity quantity) {
  for (const ExtraColumn& column : table.extra) {
    if (!column.labels.empty()) continue;
    const auto match = match_heading(parse_heading(column.name));
    if (match && match->quantity == quantity) return &column;
  }
  return nullptr;
}

const ExtraColumn* find_named_column(const LocalisationTable& table, const std::string& name) {
  for (const ExtraColumn& column : table.extra)
    if (column.name == name) return &column;
  const std::string wanted = parse_heading(name).name;
  for (const ExtraColumn& column : table.extra)
    if (parse_heading(column.name).name == wanted) return &column;
  const auto quantity = quantity_named(name);
  return quantity ? find_column(table, *quantity) : nullptr;
}

}  // namespace smlm
