// The rows of a text table into a LocalisationTable: one parser behind every format that is text.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "../column_plan.hpp"
#include "header.hpp"
#include "smlm/localisation_table.hpp"

namespace smlm {

/// What a format knows about its text tables beyond the general rules.
struct TextFormat {
  /// Names and meanings of the columns; by default the registry of aliases decides.
  std::function<std::vector<SourceColumn>(const TextHeader&, ReadOptions&)> columns;
  /// Data end at the first blank line (Zeiss writes a footer behind it).
  bool footer = false;
  bool reject_infinite_sigma_z = false;
};

/// Parses strictly: every line has as many fields as the header, every field is a number as a whole, or a
/// word in columns whose first row is a word. Errors are Error(input) at file:line:field. Numbers obey no
/// locale. Empty fields are NaN, which columns that are used do not accept.
LocalisationTable read_text_table(const std::string& path, const ReadOptions& options,
                                  const TextFormat& format = {});

}  // namespace smlm
