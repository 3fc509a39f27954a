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

// A column of ids as numbers of the builder's words.
std::vector<double> read_ids(const h5::File& file, const std::string& member, h5::Kind kind,
                             std::uint64_t first, std::uint64_t rows, TableBuilder& builder,
                             std::size_t column) {
  std::vector<double> ids;
  ids.reserve(rows);
  if (kind == h5::Kind::text) {
    for (const std::string& id : file.read_member_strings(locs, member, first, rows))
      ids.push_back(builder.label(column, id));
    return ids;
  }
  std::int64_t last = 0;
  for (const std::int64_t id : file.read_member<std::int64_t>(locs, member, first, rows)) {
    ids.push_back(!ids.empty() && id == last ? ids.back() : builder.label(column, std::to_string(id)));
    last = id;
  }
  return ids;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const h5::DatasetInfo info = file.info(locs);
  if (info.kind != h5::Kind::compound || info.shape.size() != 1) {
    throw Error(Fault::input, path + ":" + locs, "is not a one-dimensional table", "is the file Picasso's?");
  }
  const ReadOptions effective = with_picasso_pixel_size(path, options);
  std::vector<SourceColumn> columns;
  std::vector<h5::Kind> kind;
  for (const h5::Member& member : info.members) {
    const bool number = member.kind == h5::Kind::integer || member.kind == h5::Kind::real;
    SourceColumn column = picasso_column(member.name, effective);
    // Ids are text from here on: a double does not hold every whole number.
    column.text = column.quantity == Quantity::particle && member.kind != h5::Kind::real;
    if (member.elements != 1 || (!number && !(column.text && member.kind == h5::Kind::text))) continue;
    columns.push_back(std::move(column));
    kind.push_back(member.kind);
  }
  TableBuilder builder(path, path + ":" + locs, columns, effective);
  RowBlock block;
  block.columns.resize(columns.size());
  for (std::uint64_t first = 0; first < info.shape[0]; first += block_rows) {
    const std::uint64_t rows = std::min(block_rows, info.shape[0] - first);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      block.columns[i] = columns[i].text ? read_ids(file, columns[i].name, kind[i], first, rows, builder, i)
                                         : file.read_member<double>(locs, columns[i].name, first, rows);
    }
    if (first == 0) builder.require_memory_for(info.shape[0]);  // a claim that reading has found credible
    block.row.resize(rows);
    for (std::uint64_t row = 0; row < rows; ++row) block.row[row] = first + row + 1;
    builder.append(block);
  }
  LocalisationTable table = builder.finish();
  judge_lpz(table, columns);
  return table;
}

}  // namespace

const TableReader picasso{"picasso", "Picasso (.hdf5 with .yaml)", recognises, read};

}  // namespace smlm::readers
