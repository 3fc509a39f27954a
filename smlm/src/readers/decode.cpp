// DECODE: HDF5 with /data/xyz (N, 3) and /data/xyz_sig (standard deviations) or xyz_cr (Cramer-Rao
// variances), where "nothing" is an empty data space; or a CSV whose comments hold the same attributes as
// JSON. x and y are in pixels (two sizes) or nm as xy_unit says, z always in nm. x stays DECODE's x, the
// image row.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "../column_arrays.hpp"
#include "../text/text_table.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr std::array axes{"x", "y", "z"};

/// nm per unit of x and of y.
using LateralUnit = std::array<double, 2>;

LateralUnit lateral_unit(const std::string& path, const std::string& unit,
                         const std::vector<double>& pixel_nm, const ReadOptions& options) {
  if (unit == "nm") return {1, 1};
  if (unit != "px")
    throw Error(Fault::input, path, "xy_unit is '" + unit + "', neither px nor nm", "write it again");
  if (options.pixel_size_nm > 0) return {options.pixel_size_nm, options.pixel_size_nm};
  if (pixel_nm.size() == 2 && pixel_nm[0] > 0 && pixel_nm[1] > 0) return {pixel_nm[0], pixel_nm[1]};
  throw Error(Fault::input, path, "is in pixels and px_size is not given", "set input.pixel_size_nm");
}

SourceColumn position_column(std::size_t axis, const LateralUnit& lateral) {
  return {axes[axis], "", static_cast<Quantity>(axis), Spread::standard_deviation,
          axis < 2 ? lateral[axis] : 1.0};
}

SourceColumn uncertainty_column(const std::string& name, std::size_t axis, bool variance,
                                const LateralUnit& lateral) {
  const auto quantity = static_cast<Quantity>(static_cast<std::size_t>(Quantity::sigma_x) + axis);
  return {name, "", quantity, variance ? Spread::variance : Spread::standard_deviation,
          axis < 2 ? lateral[axis] : 1.0};
}

bool recognises(const FileHead& head) {
  if (head.hdf5) {
    const h5::File file = h5::File::open(head.path);
    return file.is_dataset("/data/xyz") && file.has_attribute("/meta", "xy_unit");
  }
  return head.bytes.rfind("# DECODE EmitterSet", 0) == 0;
}

// The three columns of an (N, 3) data set; empty when the set is.
std::vector<std::vector<double>> split(const h5::File& file, const std::string& object, std::uint64_t rows) {
  const h5::DatasetInfo info = file.info(object);
  if (info.null) return {};
  if (info.shape != h5::Shape{rows, 3}) {
    throw Error(Fault::input, file.path() + ":" + object, "does not have one x, y, z per row",
                "write it again");
  }
  const auto values = file.read<double>(object);
  std::vector<std::vector<double>> columns(3, std::vector<double>(rows));
  for (std::uint64_t i = 0; i < values.size(); ++i) columns[i % 3][i / 3] = values[i];
  return columns;
}

LocalisationTable read_h5(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  const std::string unit = file.read_string_attribute("/meta", "xy_unit");
  const auto pixel = file.has_attribute("/meta", "px_size") ? file.read_attribute<double>("/meta", "px_size")
                                                            : std::vector<double>{};
  const LateralUnit lateral = lateral_unit(path, unit, pixel, options);
  const h5::DatasetInfo xyz = file.info("/data/xyz");
  const std::uint64_t rows = xyz.shape.empty() ? 0 : xyz.shape[0];
  std::vector<ColumnArray> arrays;
  auto positions = split(file, "/data/xyz", rows);
  positions.resize(3);
  for (std::size_t axis = 0; axis < 3; ++axis)
    arrays.push_back({position_column(axis, lateral), std::move(positions[axis])});
  for (const bool variance : {false, true}) {
    const std::string name = variance ? "xyz_cr" : "xyz_sig";
    if (!file.is_dataset("/data/" + name)) continue;
    auto columns = split(file, "/data/" + name, rows);
    if (columns.empty() || rows == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      arrays.push_back(
          {uncertainty_column(name + "." + axes[axis], axis, variance, lateral), std::move(columns[axis])});
    }
    break;  // the estimated standard deviations are preferred to the bounds
  }
  for (const auto& [name, quantity] :
       {std::pair{"frame_ix", Quantity::frame}, std::pair{"phot", Quantity::photons},
        std::pair{"bg", Quantity::background}, std::pair{"id", Quantity::other},
        std::pair{"prob", Quantity::other}}) {
    const std::string object = std::string("/data/") + name;
    if (!file.is_dataset(object)) continue;
    const h5::DatasetInfo info = file.info(object);
    if (!info.null && info.shape == h5::Shape{rows})
      arrays.push_back({{name, "", quantity}, file.read<double>(object)});
  }
  LocalisationTable table = build_table(path, path + ":/data", std::move(arrays), options);
  if (unit == "px") table.keys_used.insert("pixel_size_nm");
  return table;
}

// The comments are "DECODE EmitterSet", then one JSON object each for the version and for the units.
LateralUnit unit_from_comments(const std::string& path, const TextHeader& header,
                               const ReadOptions& options) {
  for (const std::string& comment : header.comments) {
    const auto json = nlohmann::json::parse(comment, nullptr, false);
    if (!json.is_object() || !json.contains("xy_unit")) continue;
    std::vector<double> pixel;
    if (json.contains("px_size") && json["px_size"].is_array()) {
      for (const auto& value : json["px_size"]) pixel.push_back(value.is_number() ? value.get<double>() : 0);
    }
    return lateral_unit(path, json["xy_unit"].is_string() ? json["xy_unit"].get<std::string>() : "", pixel,
                        options);
  }
  throw Error(Fault::input, path, "its comments do not say xy_unit",
              "name the columns with input.format: csv");
}

std::vector<SourceColumn> csv_columns(const std::string& path, const TextHeader& header,
                                      const ReadOptions& options) {
  const LateralUnit lateral = unit_from_comments(path, header, options);
  const auto has = [&](const std::string& name) {
    return std::find(header.cells.begin(), header.cells.end(), name) != header.cells.end();
  };
  const bool variance = !has("x_sig");
  std::vector<SourceColumn> columns = columns_by_role(
      header.cells,
      {{"frame_ix", Quantity::frame}, {"phot", Quantity::photons}, {"bg", Quantity::background}});
  for (SourceColumn& column : columns) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (column.name == axes[axis]) column = position_column(axis, lateral);
      if (column.name == std::string(axes[axis]) + (variance ? "_cr" : "_sig")) {
        column = uncertainty_column(column.name, axis, variance, lateral);
      }
    }
  }
  return columns;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  if (h5::File::is_hdf5(path)) return read_h5(path, options);
  TextFormat format;
  format.columns = [&path](const TextHeader& header, ReadOptions& effective) {
    return csv_columns(path, header, effective);
  };
  LocalisationTable table = read_text_table(path, options, format);
  if (units::length_of(table.position_unit_nm) == units::Length::pixel)
    table.keys_used.insert("pixel_size_nm");
  return table;
}

}  // namespace

const TableReader decode{"decode", "DECODE (.h5, .csv)", recognises, read};

}  // namespace smlm::readers
