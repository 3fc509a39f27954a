// Picasso tables that were written with pandas' to_hdf instead of as a compound data set: the group /locs
// holds axis0 (all column names) and, per type, blockN_items (names) and blockN_values (rows x names). The
// same meanings as in Picasso's own files; Picasso 0.11 refuses these.
#include "../column_arrays.hpp"
#include "picasso_columns.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr std::size_t most_blocks = 64;

bool recognises(const FileHead& head) {
  return head.hdf5 && h5::File::open(head.path).exists("/locs/block0_values");
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const ReadOptions effective = with_picasso_pixel_size(path, options);
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
    const auto values = file.read<double>(stem + "_values");
    for (std::size_t i = 0; i < names.size(); ++i) {
      ColumnArray array{picasso_column(names[i], effective), std::vector<double>(rows)};
      for (std::uint64_t row = 0; row < rows; ++row) array.values[row] = values[row * names.size() + i];
      arrays.push_back(std::move(array));
    }
  }
  std::vector<SourceColumn> columns;
  for (const ColumnArray& array : arrays) columns.push_back(array.column);
  LocalisationTable table = build_table(path, path + ":/locs", std::move(arrays), effective);
  judge_lpz(table, columns);
  return table;
}

}  // namespace

const TableReader picasso_pandas{"picasso_pandas", "Picasso tables written by pandas (.hdf5)", recognises,
                                 read};

}  // namespace smlm::readers
