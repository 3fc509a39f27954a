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
       {{"x"}, {"xnm", "nm"}, {"xpix", "px"}, {"position_x"}, {"pos_x"}, {"x_position"}}},
      {Quantity::y,
       "y",
       "nm",
       "position, second lateral axis",
       {{"y"}, {"ynm", "nm"}, {"ypix", "px"}, {"position_y"}, {"pos_y"}, {"y_position"}}},
      {Quantity::z,
       "z",
       "nm",
       "position along the optical axis",
       {{"z"}, {"znm", "nm"}, {"position_z"}, {"pos_z"}, {"z_position"}}},
      {Quantity::sigma_x,
       "sigma_x",
       "nm",
       "standard deviation of x",
       {{"sigma_x"},
        {"sigmax"},
        {"sigx"},
        {"x_sig"},
        {"\xCF\x83x"},
        {"\xCF\x83_x"},
        {"uncertainty_x"},
        {"lpx"},
        {"xnmerr", "nm"},
        {"x_precision"},
        {"xprecision"},
        {"precision_x"},
        {"precisionx"},
        {"std_x"},
        {"crlb_x"},
        {"crlb_xnm", "nm"},
        {"localization_precision_x"},
        {"localisation_precision_x"}}},
      {Quantity::sigma_y,
       "sigma_y",
       "nm",
       "standard deviation of y",
       {{"sigma_y"},
        {"sigmay"},
        {"sigy"},
        {"y_sig"},
        {"\xCF\x83y"},
        {"\xCF\x83_y"},
        {"uncertainty_y"},
        {"lpy"},
        {"ynmerr", "nm"},
        {"y_precision"},
        {"yprecision"},
        {"precision_y"},
        {"precisiony"},
        {"std_y"},
        {"crlb_y"},
        {"crlb_ynm", "nm"},
        {"localization_precision_y"},
        {"localisation_precision_y"}}},
      {Quantity::sigma_z,
       "sigma_z",
       "nm",
       "standard deviation of z",
       {{"sigma_z"},
        {"sigmaz"},
        {"sigz"},
        {"z_sig"},
        {"\xCF\x83z"},
        {"\xCF\x83_z"},
        {"uncertainty_z"},
        {"lpz"},
        {"locprecznm", "nm"},
        {"locprecz"},
        {"z_precision"},
        {"zprecision"},
        {"precision_z"},
        {"precisionz"},
        {"std_z"},
        {"crlb_z"},
        {"axial_uncertainty"},
        {"localization_precision_z"},
        {"localisation_precision_z"}}},
      {Quantity::sigma_lateral,
       "sigma_xy",
       "nm",
       "standard deviation of x and of y, one value for both",
       {{"sigma_xy"},
        {"sigmaxy"},
        {"sigma_lateral"},
        {"\xCF\x83xy"},
        {"\xCF\x83_xy"},
        {"uncertainty_xy"},
        {"uncertainty"},
        {"locprecnm", "nm"},
        {"locprec"},
        {"precision"},
        {"precision_xy"},
        {"lateral_uncertainty"},
        {"lateral_precision"},
        {"localization_precision"},
        {"localisation_precision"},
        {"lateral_localization_accuracy"},
        {"sigma", {}, true}}},
      {Quantity::sigma_xx,
       "sigma_xx",
       "nm^2",
       "covariance, variance of x",
       {{"sigma_xx"}, {"cov_xx"}, {"var_x"}}},
      {Quantity::sigma_xy,
       "sigma_xy",
       "nm^2",
       "covariance of x and y (where sigma_xx is given)",
       {{"cov_xy"}}},
      {Quantity::sigma_xz, "sigma_xz", "nm^2", "covariance of x and z", {{"sigma_xz"}, {"cov_xz"}}},
      {Quantity::sigma_yy,
       "sigma_yy",
       "nm^2",
       "covariance, variance of y",
       {{"sigma_yy"}, {"cov_yy"}, {"var_y"}}},
      {Quantity::sigma_yz, "sigma_yz", "nm^2", "covariance of y and z", {{"sigma_yz"}, {"cov_yz"}}},
      {Quantity::sigma_zz,
       "sigma_zz",
       "nm^2",
       "covariance, variance of z",
       {{"sigma_zz"}, {"cov_zz"}, {"var_z"}}},
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
    if (c == ' ' || c == '-' || c == '.') {
      if (!out.empty() && out.back() != '_') out += '_';
    } else {
      out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
  }
  return out;
}

// "x_nm", "xnm_": a unit as the last word. Only units that no quantity is named after.
bool split_suffix(Heading& heading) {
  static constexpr std::array<std::string_view, 6> suffixes{"_nm",  "_um",    "_px",
                                                            "_pix", "_pixel", "_\xC2\xB5m"};
  for (const std::string_view suffix : suffixes) {
    if (heading.name.size() > suffix.size() &&
        heading.name.compare(heading.name.size() - suffix.size(), suffix.size(), suffix) == 0) {
      heading.unit = suffix.substr(1);
      heading.name.resize(heading.name.size() - suffix.size());
      return true;
    }
  }
  return false;
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
  while (!heading.name.empty() && heading.name.back() == '_') heading.name.pop_back();
  split_suffix(heading);
  return heading;
}

std::optional<ColumnMatch> match_heading(const Heading& heading) {
  for (const ColumnSpec& spec : column_registry()) {
    for (const Alias& alias : spec.aliases) {
      if (alias.name != heading.name) continue;
      return ColumnMatch{spec.quantity, heading.unit.empty() ? std::string(alias.unit) : heading.unit,
                         alias.weak};
    }
  }
  return std::nullopt;
}

}  // namespace smlm
