// Picasso's .hdf5: the compound data set /locs, fields by name whatever their types; x, y, lpx, lpy in camera
// pixels, z and lpz in nm, group the particle. The pixel size is in the sidecar .yaml. SMAP's exporter writes
// the same with doubles and a sidecar without Pixelsize.
#include <algorithm>
#include <cmath>

#include "../table_builder.hpp"
#include "picasso_sidecar.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr std::uint64_t block_rows = 65536;
constexpr auto locs = "/locs";
// An axial precision below this is better than any microscope's in nm, and usual in pixels.
constexpr double suspicious_lpz_nm = 1.5;

bool recognises(const FileHead& head) {
  if (!head.hdf5) return false;
  const h5::File file = h5::File::open(head.path);
  return file.is_dataset(locs) && file.info(locs).kind == h5::Kind::compound;
}

// sx, sy are widths of the PSF, never uncertainties; what is not listed is kept as an extra column.
SourceColumn describe(const h5::Member& member, const ReadOptions& options) {
  SourceColumn column{member.name, {}, Quantity::other};
  if (member.name == "x" || member.name == "y") {
    column.quantity = member.name == "x" ? Quantity::x : Quantity::y;
    column.unit = "px";
  } else if (member.name == "z") {
    column.quantity = Quantity::z;
    column.unit = "nm";
  } else if (member.name == "lpx" || member.name == "lpy") {
    column.quantity = member.name == "lpx" ? Quantity::sigma_x : Quantity::sigma_y;
    column.unit = "px";
  } else if (member.name == "lpz") {
    column.quantity = Quantity::sigma_z;
    column.unit = options.lpz_unit;
  } else if (member.name == "group") {
    column.quantity = Quantity::particle;
  } else if (member.name == "frame") {
    column.quantity = Quantity::frame;
  } else if (member.name == "photons") {
    column.quantity = Quantity::photons;
  } else if (member.name == "bg") {
    column.quantity = Quantity::background;
  }
  return column;
}

double median_axial_sigma_nm(const LocalisationTable& table) {
  std::vector<float> variances;
  variances.reserve(table.size());
  for (const Covariance& covariance : table.covariance_nm2) variances.push_back(covariance[5]);
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::sqrt(static_cast<double>(*middle));
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const h5::DatasetInfo info = file.info(locs);
  if (info.kind != h5::Kind::compound || info.shape.size() != 1) {
    throw Error(Fault::input, path + ":" + locs, "is not a one-dimensional table", "is the file Picasso's?");
  }
  ReadOptions effective = options;
  if (!(effective.pixel_size_nm > 0)) {
    const std::string sidecar = picasso_sidecar_path(path);
    const auto pixel_size_nm = picasso_pixel_size_nm(sidecar);
    if (!pixel_size_nm) {
      throw Error(Fault::input, path,
                  "the size of a camera pixel is not known: '" + sidecar + "' holds no Pixelsize",
                  "set input.pixel_size_nm");
    }
    effective.pixel_size_nm = *pixel_size_nm;
  }

  std::vector<SourceColumn> columns;
  for (const h5::Member& member : info.members) {
    const bool number = member.kind == h5::Kind::integer || member.kind == h5::Kind::real;
    if (number && member.elements == 1) columns.push_back(describe(member, effective));
  }
  TableBuilder builder(path, path + ":" + locs, columns, effective);
  RowBlock block;
  block.columns.resize(columns.size());
  for (std::uint64_t first = 0; first < info.shape[0]; first += block_rows) {
    const std::uint64_t rows = std::min(block_rows, info.shape[0] - first);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      block.columns[i] = file.read_member<double>(locs, columns[i].name, first, rows);
    }
    block.row.resize(rows);
    for (std::uint64_t row = 0; row < rows; ++row) block.row[row] = first + row + 1;
    builder.append(block);
  }
  LocalisationTable table = builder.finish();
  const bool has_lpz = info.member("lpz") != nullptr && !table.planar;
  if (has_lpz && table.size() > 0 && median_axial_sigma_nm(table) < suspicious_lpz_nm) {
    table.warnings.push_back("the median of lpz is below 1.5 nm: is it in pixels? (input.lpz_unit: px)");
  }
  return table;
}

}  // namespace

const TableReader picasso{"picasso", "Picasso (.hdf5 with .yaml)", recognises, read};

}  // namespace smlm::readers
