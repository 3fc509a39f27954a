#include "fit_tables.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>

#include "results/csv_line.hpp"

namespace polar::pipeline {

namespace {
using fitting::GeometricModel;
using fitting::ModelFit;
using results::csv_field;
using results::csv_number;

nlohmann::json quantity(const std::string& unit, const std::string& about, double value, double std_error) {
  return {{"unit", unit}, {"about", about}, {"value", value}, {"std", std_error}};
}

nlohmann::json gain_json(const fitting::Gain& g) {
  return {{"gain", g.gain}, {"standard_error", g.standard_error}, {"particles", g.particles}};
}

double mean_of(const std::vector<double>& values) {
  double sum = 0, n = 0;
  for (const double v : values)
    if (std::isfinite(v)) sum += v, ++n;
  return n > 0 ? sum / n : NAN;
}

std::string bounds_touched(const GeometricModel& model, const ModelFit& fit) {
  std::string names;
  for (std::size_t i = 0; i < model.parameter.size(); ++i)
    if (fit.at_bound[i]) names += (names.empty() ? "" : " ") + model.parameter[i].name;
  return names;
}

std::string numbers_of(const GeometricModel& model, const ModelFit& fit) {
  std::string text;
  for (std::size_t i = 0; i < model.parameter.size(); ++i)
    text += csv_number(fit.value[static_cast<Eigen::Index>(i)]) + "," + csv_number(fit.std_error(i)) + ",";
  for (Eigen::Index d = 0; d < fit.derived.size(); ++d)
    text += csv_number(fit.derived[d]) + "," + csv_number(fit.derived_std[d]) + ",";
  const Eigen::Quaterniond q(fit.data_from_model.rotation);
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) text += csv_number(x) + ",";
  for (int a = 0; a < 3; ++a) text += csv_number(fit.data_from_model.translation[a]) + ",";
  return text;
}
}  // namespace

std::string with_unit(const std::string& name, const std::string& unit) {
  std::string column = name;
  if (unit == "1") return column;
  column += '_';
  for (const char c : unit)
    if (std::isalnum(static_cast<unsigned char>(c))) column += c;
  return column;
}

std::string fit_csv(const GeometricModel& model, const std::vector<NamedFit>& fits) {
  std::string text = "particle,n_localisations,n_groups,log_density,", blank;
  const auto column = [&](const std::string& name, const std::string& unit) {
    text += with_unit(name, unit) + "," + with_unit(name + "_std", unit) + ",";
    blank += ",,";
  };
  for (const auto& p : model.parameter) column(p.name, p.unit);
  for (const auto& d : model.derived) column(d.name, d.unit);
  text += "qw,qx,qy,qz,tx_nm,ty_nm,tz_nm,at_bound,reason\n";
  blank += ",,,,,,,";
  for (const NamedFit& f : fits) {
    const bool any = f.fit.value.size() > 0;
    text += csv_field(f.name) + "," + std::to_string(f.fit.localisations) + "," +
            std::to_string(f.fit.groups) + "," + (any ? csv_number(f.fit.log_density) : "") + ",";
    text += any ? numbers_of(model, f.fit) + bounds_touched(model, f.fit) : blank;
    text += "," + csv_field(f.fit.reason) + "\n";
  }
  return text;
}

std::string points_csv(const fitting::ModelPoints& points) {
  std::string text = "x_nm,y_nm,z_nm,weight\n";
  for (Eigen::Index k = 0; k < points.x_nm.cols(); ++k) {
    for (int a = 0; a < 3; ++a) text += results::csv_length(points.x_nm(a, k)) + ",";
    text += csv_number(points.weight[k]) + "\n";
  }
  return text;
}

nlohmann::json fit_json(const GeometricModel& model, const NamedFit& f) {
  nlohmann::json parameters = nlohmann::json::object(), derived = nlohmann::json::object();
  for (std::size_t i = 0; i < model.parameter.size(); ++i) {
    const auto& p = model.parameter[i];
    parameters[p.name] =
        quantity(p.unit, p.about, f.fit.value[static_cast<Eigen::Index>(i)], f.fit.std_error(i));
    parameters[p.name]["at_bound"] = static_cast<bool>(f.fit.at_bound[i]);
    parameters[p.name]["held"] = static_cast<bool>(f.fit.held[i]);
  }
  for (std::size_t d = 0; d < model.derived.size(); ++d) {
    const auto row = static_cast<Eigen::Index>(d);
    derived[model.derived[d].name] =
        quantity(model.derived[d].unit, model.derived[d].about, f.fit.derived[row], f.fit.derived_std[row]);
  }
  return {{"name", f.name},
          {"localisations", f.fit.localisations},
          {"groups", f.fit.groups},
          {"log_density", f.fit.log_density},
          {"converged", f.fit.converged},
          {"parameters", parameters},
          {"derived", derived}};
}

nlohmann::json evidence_json(const fitting::ModelEvidence& e) {
  nlohmann::json out = {
      {"meaning", "mean log density per localisation that was not fitted; gains are over the model"},
      {"model", mean_of(e.common)},
      {"model_of_each_particle", mean_of(e.own)},
      {"gain_of_each_particle", gain_json(e.own_over_common)}};
  if (!e.free.empty()) {
    out["free_template"] = mean_of(e.free);
    out["gain_of_free_template"] = gain_json(e.free_over_common);
  }
  return out;
}

std::vector<std::string> fit_lines(const GeometricModel& model, const ModelFit& fit) {
  std::vector<std::string> lines;
  char line[160];
  const auto add = [&](const std::string& name, const std::string& unit, double value, double std_error,
                       const char* instead) {
    const char* shown = unit == "1" ? "" : unit.c_str();
    if (std::isfinite(std_error))
      std::snprintf(line, sizeof line, "%-14s %.4g +- %.2g %s", name.c_str(), value, std_error, shown);
    else
      std::snprintf(line, sizeof line, "%-14s %.4g %s (%s)", name.c_str(), value, shown, instead);
    lines.emplace_back(line);
    if (lines.back().back() == ' ') lines.back().pop_back();
  };
  for (std::size_t i = 0; i < model.parameter.size(); ++i)
    add(model.parameter[i].name, model.parameter[i].unit, fit.value[static_cast<Eigen::Index>(i)],
        fit.std_error(i),
        fit.held[i]       ? "held"
        : fit.at_bound[i] ? "at its bound"
                          : "not determined");
  for (std::size_t d = 0; d < model.derived.size(); ++d)
    add(model.derived[d].name, model.derived[d].unit, fit.derived[static_cast<Eigen::Index>(d)],
        fit.derived_std[static_cast<Eigen::Index>(d)], "not determined");
  return lines;
}

}  // namespace polar::pipeline
