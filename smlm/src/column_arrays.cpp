#include "column_arrays.hpp"

#include <numeric>

namespace smlm {

LocalisationTable build_table(const std::string& file, const std::string& where,
                              std::vector<ColumnArray> arrays, const ReadOptions& options,
                              std::vector<std::uint64_t> row) {
  std::vector<SourceColumn> columns;
  RowBlock block;
  for (ColumnArray& array : arrays) {
    columns.push_back(std::move(array.column));
    block.columns.push_back(std::move(array.values));
  }
  TableBuilder builder(file, where, std::move(columns), options);
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    for (const std::string& word : arrays[i].words) block.columns[i].push_back(builder.label(i, word));
  }
  block.row = std::move(row);
  if (block.row.empty() && !block.columns.empty()) {
    block.row.resize(block.columns.front().size());
    std::iota(block.row.begin(), block.row.end(), std::uint64_t{1});
  }
  builder.append(block);
  return builder.finish();
}

}  // namespace smlm
