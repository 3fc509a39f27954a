// Readers of formats that hold whole columns share this end.
#pragma once

#include <string>
#include <vector>

#include "table_builder.hpp"

namespace smlm {

/// A column with all its values.
struct ColumnArray {
  ColumnArray(SourceColumn what, std::vector<double> all) : column(std::move(what)), values(std::move(all)) {}
  static ColumnArray of_text(SourceColumn what, std::vector<std::string> all) {
    ColumnArray array(std::move(what), {});
    array.column.text = true;
    array.words = std::move(all);
    return array;
  }
  SourceColumn column;
  std::vector<double> values;
  std::vector<std::string> words;  // instead of values, of a column of text
};

/// Builds a table from whole columns of equal length; takes their memory. `row` gives each row's 1-based
/// number in the source, empty for 1, 2, 3, ...
LocalisationTable build_table(const std::string& file, const std::string& where,
                              std::vector<ColumnArray> arrays, const ReadOptions& options,
                              std::vector<std::uint64_t> row = {});

}  // namespace smlm
