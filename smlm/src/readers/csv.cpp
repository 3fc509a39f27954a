// Any delimited text table: the registry of aliases, or `input.columns`, says which column is what.
#include <algorithm>

#include "../text/text_table.hpp"
#include "picasso_columns.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  if (head.hdf5 || head.bytes.find('\0') != std::string::npos) return false;
  try {
    const TextHeader header = header_of(head.bytes);
    // "Byte Order: <" is a sidecar and no table.
    const bool yaml = header.delimiter == ' ' && head.bytes.find(": ") < head.bytes.find('\n');
    return header.cells.size() >= 2 && !yaml;
  } catch (const Error&) {
    return false;
  }
}

// Whether the header has Picasso's names without any unit, and it is known how large its pixels are.
bool is_picasso_table(const TextHeader& header, const ReadOptions& options) {
  const auto has = [&](const std::string& name) {
    return std::find(header.cells.begin(), header.cells.end(), name) != header.cells.end();
  };
  const auto unit = units::parse_length(options.unit);
  const bool pixels = unit ? *unit == units::Length::pixel : options.pixel_size_nm > 0;
  return pixels && has("x") && has("y") && has("lpx") && has("lpy");
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  std::vector<SourceColumn> picasso;
  TextFormat format;
  format.columns = [&](const TextHeader& header, ReadOptions& effective) {
    if (!is_picasso_table(header, effective)) return columns_by_alias(header);
    for (const std::string& cell : header.cells) {
      picasso.push_back(picasso_column(cell, effective));
      if (picasso.back().quantity == Quantity::other) picasso.back() = {cell, parse_heading(cell).unit};
    }
    return picasso;
  };
  LocalisationTable table = read_text_table(path, options, format);
  if (picasso.empty()) return table;
  if (!options.unit.empty()) table.keys_used.insert("unit");
  judge_lpz(table, picasso);
  table.warnings.push_back(
      "has the columns of Picasso: x, y, lpx and lpy are taken in camera pixels, z in nm, lpz in " +
      options.lpz_unit + " (input.columns says otherwise)");
  return table;
}

}  // namespace

const TableReader csv{"csv", "delimited text with a header (comma, semicolon, tab or blanks)", recognises,
                      read};

}  // namespace smlm::readers
