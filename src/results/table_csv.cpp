#include "polar/results/table_csv.hpp"

#include <array>
#include <cmath>
#include <set>

#include "csv_line.hpp"
#include "heading.hpp"
#include "smlm/column.hpp"

namespace polar {

namespace {
// xx xy xz yy yz zz
constexpr std::array<const char*, 6> kCovarianceNames = {"xx", "xy", "xz", "yy", "yz", "zz"};

bool diagonal(const smlm::LocalisationTable& table) {
  for (const smlm::Covariance& c : table.covariance_nm2)
    if (c[1] != 0 || c[2] != 0 || c[4] != 0) return false;
  return true;
}

// Elements of a covariance that a table of this kind has.
std::vector<std::size_t> elements(bool is_diagonal, bool planar) {
  if (is_diagonal) return planar ? std::vector<std::size_t>{0, 3} : std::vector<std::size_t>{0, 3, 5};
  return planar ? std::vector<std::size_t>{0, 1, 3} : std::vector<std::size_t>{0, 1, 2, 3, 4, 5};
}

// A kept column's heading, so that no reader takes it for a position or a particle of this table, and none
// stands twice.
std::string kept_heading(const smlm::ExtraColumn& column, std::set<std::string>& used) {
  std::string name = results::heading(column);
  const auto match = smlm::match_heading(smlm::parse_heading(name));
  if (match && (match->quantity <= smlm::Quantity::z || match->quantity == smlm::Quantity::particle))
    name = "input " + name;
  std::string unique = name;
  for (int n = 2; !used.insert(unique).second; ++n) unique = name + " (" + std::to_string(n) + ")";
  return unique;
}

std::string header(const smlm::LocalisationTable& table, bool is_diagonal) {
  std::string text = table.planar ? "x [nm],y [nm]," : "x [nm],y [nm],z [nm],";
  for (const std::size_t e : elements(is_diagonal, table.planar)) {
    const std::string name = kCovarianceNames[e];
    text += is_diagonal ? "uncertainty_" + name.substr(1) + " [nm]," : "sigma_" + name + " [nm^2],";
  }
  text += "particle";
  std::set<std::string> used;
  for (const smlm::ExtraColumn& c : table.extra) text += "," + results::csv_field(kept_heading(c, used));
  return text + "\n";
}

std::string extra_field(const smlm::ExtraColumn& column, std::size_t row) {
  const double value = column.values[row];
  if (column.labels.empty() || std::isnan(value)) return results::csv_number(value);
  return results::csv_field(column.labels[static_cast<std::size_t>(value)]);
}
}  // namespace

std::string format_table_csv(const smlm::LocalisationTable& table) {
  const bool is_diagonal = diagonal(table);
  const std::vector<std::size_t> written = elements(is_diagonal, table.planar);
  std::string text = header(table, is_diagonal);
  for (std::size_t row = 0; row < table.size(); ++row) {
    for (std::size_t axis = 0; axis < (table.planar ? 2u : 3u); ++axis)
      text += results::csv_length(table.position_nm[row][axis]) + ",";
    for (const std::size_t e : written) {
      const double value = double(table.covariance_nm2[row][e]);
      text += results::csv_length(is_diagonal ? std::sqrt(value) : value) + ",";
    }
    const std::int64_t particle = table.particle[row];
    if (particle >= 0) text += results::csv_field(table.particle_names[static_cast<std::size_t>(particle)]);
    for (const smlm::ExtraColumn& c : table.extra) text += "," + extra_field(c, row);
    text += "\n";
  }
  return text;
}

}  // namespace polar
