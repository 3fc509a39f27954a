// Inspection for people and for programs.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "smlm/inspect.hpp"

namespace smlm {
namespace {

// Six significant digits; to_chars knows no locale.
std::string number(double value) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 6).ptr;
  return {buffer.data(), end};
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string left_padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

nlohmann::json json_of(const Summary& summary) {
  return {{"minimum", summary.minimum}, {"median", summary.median}, {"maximum", summary.maximum}};
}

}  // namespace

std::string to_text(const Inspection& in) {
  std::string text;
  constexpr std::size_t most_files = 8;
  for (std::size_t i = 0; i < std::min(in.files.size(), most_files); ++i) {
    text += in.files[i] + (i < in.formats.size() ? " (" + in.formats[i] + ")" : "") + "\n";
  }
  if (in.files.size() > most_files)
    text += "and " + std::to_string(in.files.size() - most_files) + " more files\n";
  text += std::to_string(in.localisations) + " localisations" + (in.planar ? ", planar" : "");
  if (in.particles > 0) {
    const double radius_nm = in.particle_radius_nm.median;  // none where every particle is one localisation
    const std::string radius = std::isnan(radius_nm) ? "" : ", median radius " + number(radius_nm) + " nm";
    text += ", " + std::to_string(in.particles) + " particles of " +
            number(in.localisations_per_particle.minimum) + " to " +
            number(in.localisations_per_particle.maximum) + " (median " +
            number(in.localisations_per_particle.median) + ") localisations" + radius;
  } else {
    text += ", no particles";
  }
  if (in.particles > 0 && in.unassigned > 0) text += ", " + std::to_string(in.unassigned) + " in no particle";
  text += "\n";
  for (const std::string& line : in.mapping) text += "  " + line + "\n";

  std::size_t width = 6;
  for (const ColumnSummary& column : in.columns) width = std::max(width, column.name.size());
  text += "  " + padded("column", width) + "  " + padded("unit", 8) + left_padded("minimum", 14) +
          left_padded("median", 14) + left_padded("maximum", 14) + "\n";
  for (const ColumnSummary& column : in.columns) {
    text += "  " + padded(column.name, width) + "  " + padded(column.unit, 8) +
            left_padded(number(column.summary.minimum), 14) + left_padded(number(column.summary.median), 14) +
            left_padded(number(column.summary.maximum), 14) + (column.used ? "" : "  kept") + "\n";
  }
  for (const Rejection& rejection : in.rejected) {
    text += "rejected: " + std::to_string(rejection.rows) + " rows, " + rejection.reason + ", first row " +
            std::to_string(rejection.first_row) + " of " + in.files.at(rejection.file) + "\n";
  }
  for (const std::string& warning : in.warnings) text += "warning: " + warning + "\n";
  text += in.obstacle.empty() ? "polar run would start: " + std::to_string(in.particles) + " particles" +
                                    (in.planar ? ", in the plane" : "")
                              : "polar run would not start: " + in.obstacle;
  return text + "\n";
}

std::string to_json(const Inspection& in) {
  nlohmann::json json{{"files", in.files},
                      {"formats", in.formats},
                      {"localisations", in.localisations},
                      {"unassigned", in.unassigned},
                      {"particles", in.particles},
                      {"localisations_per_particle", json_of(in.localisations_per_particle)},
                      {"particle_radius_nm", json_of(in.particle_radius_nm)},
                      {"sigma_lateral_nm", json_of(in.sigma_lateral_nm)},
                      {"sigma_axial_nm", json_of(in.sigma_axial_nm)},
                      {"planar", in.planar},
                      {"axial_sigma_assumed", in.axial_sigma_assumed},
                      {"sigma_assumed", in.sigma_assumed},
                      {"mapping", in.mapping},
                      {"warnings", in.warnings},
                      {"obstacle", in.obstacle}};
  json["columns"] = nlohmann::json::array();
  for (const ColumnSummary& column : in.columns) {
    nlohmann::json entry = json_of(column.summary);
    entry["name"] = column.name;
    entry["unit"] = column.unit;
    entry["used"] = column.used;
    entry["values"] = column.values;
    json["columns"].push_back(entry);
  }
  json["rejected"] = nlohmann::json::array();
  for (const Rejection& r : in.rejected) {
    json["rejected"].push_back(
        {{"reason", r.reason}, {"rows", r.rows}, {"file", in.files.at(r.file)}, {"first_row", r.first_row}});
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace smlm
