// Picasso's .hdf5: the compound data set /locs, fields by name whatever their types; x, y, lpx, lpy in camera
// pixels, z and lpz in nm, group the particle. The pixel size is in the sidecar .yaml. SMAP's exporter writes
// the same with doubles and a sidecar without Pixelsize.
#include <algorithm>

#include "../table_builder.hpp"
#include "picasso_columns.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr std::uint64_t block_rows = 65536;
constexpr auto locs = "/locs";

bool recognises(const FileHead& head) {
  if (!head.hdf5) return false;
  const h5::File file = h5::File::open(head.path);
  return file.is_dataset(locs) && file.info(locs).kind == h5::Kind::compound;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const h5::DatasetInfo info = file.info(locs);
  if (info.kind != h5::Kind::compound || info.shape.size() != 1) {
    throw Error(Fault::input, path + ":" + locs, "is not a one-dimensional table", "is the file Picasso's?");
  }
  const ReadOptions effective = with_picasso_pixel_size(path, options);
  std::vector<SourceColumn> columns;
  for (const h5::Member& member : info.members) {
    const bool number = member.kind == h5::Kind::integer || member.kind == h5::Kind::real;
    if (number && member.elements == 1) columns.push_back(picasso_column(member.name, effective));
  }
  TableBuilder builder(path, path + ":" + locs, columns, effective);
  RowBlock block;
  block.columns.resize(columns.size());
  for (std::uint64_t first = 0; first < info.shape[0]; first += block_rows) {
    const std::uint64_t rows = std::min(block_rows, info.shape[0] - first);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      block.columns[i] = file.read_member<double>(locs, columns[i].name, first, rows);
    }
    if (first == 0) builder.require_memory_for(info.shape[0]);  // a claim that reading has found credible
    block.row.resize(rows);
    for (std::uint64_t row = 0; row < rows; ++row) block.row[row] = first + row + 1;
    builder.append(block);
  }
  LocalisationTable table = builder.finish();
  warn_about_lpz(table);
  return table;
}

}  // namespace

const TableReader picasso{"picasso", "Picasso (.hdf5 with .yaml)", recognises, read};

}  // namespace smlm::readers
