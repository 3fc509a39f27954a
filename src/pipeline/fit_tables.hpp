// What a fit writes, as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "polar/fitting/evidence.hpp"

namespace polar::pipeline {

struct NamedFit {
  std::string name;
  fitting::ModelFit fit;
};

/// A column's name: the quantity with its unit, as in `radius_nm`.
std::string with_unit(const std::string& name, const std::string& unit);

std::string fit_csv(const fitting::GeometricModel& model, const std::vector<NamedFit>& fits);

std::string points_csv(const fitting::ModelPoints& points);

nlohmann::json fit_json(const fitting::GeometricModel& model, const NamedFit& fit);

nlohmann::json evidence_json(const fitting::ModelEvidence& evidence);

/// "radius 53.41 +- 0.11 nm", one line a quantity.
std::vector<std::string> fit_lines(const fitting::GeometricModel& model, const fitting::ModelFit& fit);

}  // namespace polar::pipeline
