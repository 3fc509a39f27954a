#include "picasso_columns.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "picasso_sidecar.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

// An axial precision below this is better than any microscope's in nm, and usual in pixels.
constexpr double suspicious_lpz_nm = 1.5;

struct Known {
  std::string_view name, unit;
  Quantity quantity;
};

}  // namespace

SourceColumn picasso_column(const std::string& name, const ReadOptions& options) {
  const Known known[]{{"x", "px", Quantity::x},           {"y", "px", Quantity::y},
                      {"z", "nm", Quantity::z},           {"lpx", "px", Quantity::sigma_x},
                      {"lpy", "px", Quantity::sigma_y},   {"lpz", options.lpz_unit, Quantity::sigma_z},
                      {"group", "", Quantity::particle},  {"frame", "", Quantity::frame},
                      {"photons", "", Quantity::photons}, {"bg", "", Quantity::background}};
  for (const Known& column : known) {
    if (column.name == name) return {name, std::string(column.unit), column.quantity};
  }
  return {name, "", Quantity::other};
}

ReadOptions with_picasso_pixel_size(const std::string& path, const ReadOptions& options) {
  if (options.pixel_size_nm > 0) return options;
  const std::string sidecar = picasso_sidecar_path(path);
  const auto pixel_size_nm = picasso_pixel_size_nm(sidecar);
  if (!pixel_size_nm) {
    throw Error(Fault::input, path,
                "the size of a camera pixel is not known: '" + sidecar + "' holds no Pixelsize",
                "set input.pixel_size_nm");
  }
  ReadOptions effective = options;
  effective.pixel_size_nm = *pixel_size_nm;
  return effective;
}

void judge_lpz(LocalisationTable& table, const std::vector<SourceColumn>& columns) {
  const bool has_lpz = std::any_of(columns.begin(), columns.end(), [](const SourceColumn& c) {
    return c.quantity == Quantity::sigma_z && c.name == "lpz";
  });
  if (has_lpz) table.keys_used.insert("lpz_unit");
  if (table.planar || table.axial_sigma_assumed || table.size() == 0) return;
  std::vector<float> variances;
  variances.reserve(table.size());
  for (const Covariance& covariance : table.covariance_nm2) variances.push_back(covariance[5]);
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  if (std::sqrt(static_cast<double>(*middle)) < suspicious_lpz_nm) {
    table.warnings.push_back("the median of lpz is below 1.5 nm: is it in pixels? (input.lpz_unit: px)");
  }
}

}  // namespace smlm::readers
