#include "smlm/column.hpp"

#include <algorithm>
#include <array>

namespace smlm {

const std::vector<ColumnSpec>& column_registry() {
  static const std::vector<ColumnSpec> registry{
      {Quantity::x,
       "x",
       "nm",
       "position, first lateral axis",
       {{"x"}, {"xnm", "nm"}, {"xpix", "px"}, {"position_x"}, {"pos_x"}, {"x_position"}, {"x_pos"}}},
      {Quantity::y,
       "y",
       "nm",
       "position, second lateral axis",
       {{"y"}, {"ynm", "nm"}, {"ypix", "px"}, {"position_y"}, {"pos_y"}, {"y_position"}, {"y_pos"}}},
      {Quantity::z,
       "z",
       "nm",
       "position along the optical axis",
       {{"z"}, {"znm", "nm"}, {"position_z"}, {"pos_z"}, {"z_position"}, {"z_pos"}}},
      {Quantity::sigma_x, "sigma_x", "nm", "standard deviation of x", {{"xnmerr", "nm"}, {"crlb_xnm", "nm"}}},
      {Quantity::sigma_y, "sigma_y", "nm", "standard deviation of y", {{"ynmerr", "nm"}, {"crlb_ynm", "nm"}}},
      {Quantity::sigma_z, "sigma_z", "nm", "standard deviation of z", {{"locprecznm", "nm"}}},
      {Quantity::sigma_lateral,
       "sigma_xy",
       "nm",
       "standard deviation of x and of y, one value for both",
       {{"locprecnm", "nm"}}},
      {Quantity::sigma_xx, "sigma_xx", "nm^2", "covariance, variance of x", {{"sigma_xx"}, {"cov_xx"}}},
      {Quantity::sigma_xy,
       "sigma_xy",
       "nm^2",
       "covariance of x and y (where sigma_xx is given)",
       {{"cov_xy"}}},
      {Quantity::sigma_xz, "sigma_xz", "nm^2", "covariance of x and z", {{"sigma_xz"}, {"cov_xz"}}},
      {Quantity::sigma_yy, "sigma_yy", "nm^2", "covariance, variance of y", {{"sigma_yy"}, {"cov_yy"}}},
      {Quantity::sigma_yz, "sigma_yz", "nm^2", "covariance of y and z", {{"sigma_yz"}, {"cov_yz"}}},
      {Quantity::sigma_zz, "sigma_zz", "nm^2", "covariance, variance of z", {{"sigma_zz"}, {"cov_zz"}}},
      {Quantity::particle,
       "particle",
       "",
       "which copy of the structure a row belongs to: a number or a name",
       {{"particle"},
        {"particle_id"},
        {"particleid"},
        {"particle_index"},
        {"group"},
        {"sitenumbers"},
        {"sitenumber"},
        {"site"},
        {"pick"}}},
      {Quantity::frame,
       "frame",
       "",
       "camera frame",
       {{"frame"}, {"frame_ix"}, {"frame_number"}, {"first_frame"}, {"framenumber"}, {"imagenumber_0_0"}}},
      {Quantity::photons,
       "photons",
       "photon",
       "detected photons",
       {{"photons"}, {"intensity"}, {"phot"}, {"number_photons"}, {"photon_count"}}},
      {Quantity::background,
       "background",
       "photon",
       "background photons",
       {{"background"}, {"bg"}, {"offset"}, {"local_background"}}},
  };
  return registry;
}

const ColumnSpec& column_spec(Quantity quantity) {
  return column_registry()[static_cast<std::size_t>(quantity)];
}

std::optional<Quantity> quantity_named(std::string_view canonical_name) {
  for (const ColumnSpec& spec : column_registry()) {
    if (spec.name == canonical_name) return spec.quantity;  // the lateral sigma_xy stands first
  }
  return std::nullopt;
}

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\"";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string normalised(std::string_view name) {
  std::string out;
  for (const char c : trimmed(name)) {
    if (c == ' ' || c == '-' || c == '.' || c == '_') {
      if (!out.empty() && out.back() != '_') out += '_';
    } else {
      out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
  }
  while (!out.empty() && out.back() == '_') out.pop_back();
  return out;
}

// "x_nm", "var_x_nm2": a unit as the last word. Only units that no quantity is named after.
void split_suffix(Heading& heading) {
  const auto at = heading.name.rfind('_');
  if (at == std::string::npos || at == 0) return;
  static constexpr std::array<std::string_view, 9> units{
      "nm", "um", "px", "pix", "pixel", "pixels", "\xC2\xB5m", "\xCE\xBCm", "angstrom"};
  const std::string_view last = std::string_view(heading.name).substr(at + 1);
  if (std::find(units.begin(), units.end(), units::without_square(last)) == units.end()) return;
  heading.unit = last;
  heading.name.resize(at);
}

}  // namespace

Heading parse_heading(std::string_view cell) {
  cell = trimmed(cell);
  for (const auto& [open, close] : {std::pair{'[', ']'}, std::pair{'(', ')'}}) {
    const auto start = cell.rfind(open);
    if (start != std::string_view::npos && start > 0 && cell.back() == close) {
      return {normalised(cell.substr(0, start)),
              std::string(trimmed(cell.substr(start + 1, cell.size() - start - 2)))};
    }
  }
  Heading heading{normalised(cell), {}};
  split_suffix(heading);
  return heading;
}

std::optional<ColumnMatch> match_heading(const Heading& heading) {
  for (const ColumnSpec& spec : column_registry()) {
    for (const Alias& alias : spec.aliases) {
      if (alias.name != heading.name) continue;
      const bool covariance = spec.quantity >= Quantity::sigma_xx && spec.quantity <= Quantity::sigma_zz;
      return ColumnMatch{spec.quantity, heading.unit.empty() ? std::string(alias.unit) : heading.unit,
                         Claim::plain, covariance ? Spread::variance : Spread::standard_deviation};
    }
  }
  auto match = uncertainty_named(heading.name);
  if (match && !heading.unit.empty()) match->unit = heading.unit;
  return match;
}

}  // namespace smlm
