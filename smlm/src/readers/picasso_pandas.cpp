// Picasso tables that were written with pandas' to_hdf instead of as a compound data set: the group /locs
// holds axis0 (all column names) and, per type, blockN_items (names) and blockN_values (rows x names), or,
// with format='table', one compound data set. The same meanings as in Picasso's own files; Picasso 0.11
// refuses these.
#include <sstream>

#include "../column_arrays.hpp"
#include "picasso_columns.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr std::size_t most_blocks = 64;

constexpr auto table = "/locs/table";

bool recognises(const FileHead& head) {
  if (!head.hdf5) return false;
  const h5::File file = h5::File::open(head.path);
  return file.exists("/locs/block0_values") || file.is_dataset(table);
}

// Column `column` of a row-major block. Ids are text from here on: a double does not hold every whole number.
template <class T>
std::vector<T> column_of(const std::vector<T>& block, std::size_t columns, std::size_t column) {
  std::vector<T> values;
  values.reserve(block.size() / columns);
  for (std::size_t at = column; at < block.size(); at += columns) values.push_back(block[at]);
  return values;
}

// Appends the columns of a block; `read<T>()` gives its values row by row.
template <class Read>
void append_block(std::vector<ColumnArray>& arrays, const std::vector<std::string>& names, h5::Kind kind,
                  const ReadOptions& options, const Read& read) {
  const std::vector<double> values = read(double());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const SourceColumn column = picasso_column(names[i], options);
    if (column.quantity != Quantity::particle || kind != h5::Kind::integer) {
      arrays.emplace_back(column, column_of(values, names.size(), i));
      continue;
    }
    std::vector<std::string> ids;
    for (const std::int64_t id : column_of(read(std::int64_t()), names.size(), i))
      ids.push_back(std::to_string(id));
    arrays.push_back(ColumnArray::of_text(column, std::move(ids)));
  }
}

// to_hdf's `fixed`: per type blockN_items and blockN_values.
std::vector<ColumnArray> read_fixed(const std::string& path, const h5::File& file,
                                    const ReadOptions& options) {
  std::vector<ColumnArray> arrays;
  std::uint64_t rows = 0;
  for (std::size_t block = 0; block < most_blocks; ++block) {
    const std::string stem = "/locs/block" + std::to_string(block);
    if (!file.is_dataset(stem + "_values")) break;
    const auto names = file.read_strings(stem + "_items");
    const h5::DatasetInfo info = file.info(stem + "_values");
    if (block == 0 && !info.shape.empty()) rows = info.shape[0];
    if (info.shape != h5::Shape{rows, names.size()}) {
      throw Error(Fault::input, path + ":" + stem + "_values", "does not have one column per name",
                  "write it again");
    }
    if (info.kind != h5::Kind::integer && info.kind != h5::Kind::real) continue;
    append_block(arrays, names, info.kind, options,
                 [&](auto type) { return file.read<decltype(type)>(stem + "_values"); });
  }
  return arrays;
}

// The names of a block, which PyTables keeps as a pickled list of texts in protocol 0. Nothing is unpickled:
// a name is what stands behind a V at the beginning of a line, or behind the a that appended the one before.
std::vector<std::string> pickled_names(const std::string& pickle) {
  std::vector<std::string> names;
  std::istringstream lines(pickle);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() == 'a') line.erase(0, 1);
    if (!line.empty() && line.front() == 'V') names.push_back(line.substr(1));
    if (line.size() > 3 && line.front() == 'S') names.push_back(line.substr(2, line.size() - 3));
  }
  return names;
}

// to_hdf's `table`: a compound with one array field a type, or a field of its own for each data column.
std::vector<ColumnArray> read_appendable(const std::string& path, const h5::File& file,
                                         const ReadOptions& options) {
  const h5::DatasetInfo info = file.info(table);
  if (info.kind != h5::Kind::compound || info.shape.size() != 1)
    throw Error(Fault::input, path + ":" + table, "is not a one-dimensional table", "write it again");
  const std::uint64_t rows = info.shape[0];
  std::vector<ColumnArray> arrays;
  for (const h5::Member& member : info.members) {
    if (member.name == "index") continue;
    const bool block = member.name.rfind("values_block_", 0) == 0;
    const std::string kept_as = member.name + "_kind";
    std::vector<std::string> names{member.name};
    if (block && file.has_attribute(table, kept_as))
      names = pickled_names(file.read_string_attribute(table, kept_as));
    if (names.size() != member.elements)
      throw Error(Fault::input, path + ":" + table,
                  "its field '" + member.name + "' does not have one column per name",
                  "write it with format='fixed', or as CSV");
    if (member.kind == h5::Kind::text &&
        picasso_column(names.front(), options).quantity == Quantity::particle) {
      arrays.push_back(ColumnArray::of_text(picasso_column(names.front(), options),
                                            file.read_member_strings(table, member.name, 0, rows)));
    } else if (member.kind == h5::Kind::integer || member.kind == h5::Kind::real) {
      append_block(arrays, names, member.kind, options,
                   [&](auto type) { return file.read_member<decltype(type)>(table, member.name, 0, rows); });
    }
  }
  return arrays;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const ReadOptions effective = with_picasso_pixel_size(path, options);
  std::vector<ColumnArray> arrays =
      file.is_dataset(table) ? read_appendable(path, file, effective) : read_fixed(path, file, effective);
  std::vector<SourceColumn> columns;
  for (const ColumnArray& array : arrays) columns.push_back(array.column);
  LocalisationTable result = build_table(path, path + ":/locs", std::move(arrays), effective);
  judge_lpz(result, columns);
  return result;
}

}  // namespace

const TableReader picasso_pandas{"picasso_pandas", "Picasso tables written by pandas (.hdf5)", recognises,
                                 read};

}  // namespace smlm::readers
