// The rows of a text table into a LocalisationTable: one parser behind every format that is text.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../column_plan.hpp"
#include "header.hpp"
#include "smlm/localisation_table.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {

/// What a format knows about its text tables beyond the general rules.
struct TextFormat {
  /// Names and meanings of the columns; by default the registry of aliases decides.
  std::function<std::vector<SourceColumn>(const TextHeader&, ReadOptions&)> columns;
  /// Data end at the first blank line or NUL byte (Zeiss writes a footer behind them).
  bool footer = false;
  /// Lines may have more fields than there are columns: the rest is a nested table (rapidSTORM's tracks).
  bool ignore_further_fields = false;
  bool reject_infinite_sigma_z = false;
};

/// What a format calls a quantity: the normalised name of a header cell (see Heading).
struct Role {
  std::string_view name;
  Quantity quantity;
  std::string_view unit = {};  // where the header does not say
};

/// What the registry of aliases makes of the header's cells.
std::vector<SourceColumn> columns_by_alias(const TextHeader& header);

/// Columns whose header cell has a role get it; all others are only kept.
std::vector<SourceColumn> columns_by_role(const std::vector<std::string>& cells,
                                          const std::vector<Role>& roles);

/// The same for tables that give lengths in camera pixels and in nm side by side: pixels are only kept.
std::vector<SourceColumn> nm_columns_by_role(const std::vector<std::string>& cells,
                                             const std::vector<Role>& roles);

/// Parses strictly: every line has as many fields as the header; in columns that are used every field is a
/// number as a whole (with a decimal comma where commas do not separate fields) or says that there is none; a
/// column that is only kept becomes one of text where a row has a word in it. Errors are Error(input) at
/// file:line:field. Numbers obey no locale.
LocalisationTable read_text_table(const std::string& path, const ReadOptions& options,
                                  const TextFormat& format = {});

/// A format whose header cells have these meanings, for `read` of a TableReader: nothing else is special.
using ColumnsOf = std::vector<SourceColumn> (*)(const TextHeader&, ReadOptions&);
template <ColumnsOf columns>
LocalisationTable read_with_columns(const std::string& path, const ReadOptions& options) {
  TextFormat format;
  format.columns = columns;
  return read_text_table(path, options, format);
}

/// Whether the beginning of a file has a header with all these cells (normalised names).
bool header_has(const FileHead& head, const std::vector<std::string_view>& names);

}  // namespace smlm
