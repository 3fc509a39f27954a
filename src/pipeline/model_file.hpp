// Model files: geometry as YAML (docs/fit.md). Those of configs/models are part of the program.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "polar/fitting/geometric_model.hpp"

namespace polar::pipeline {

/// The shipped files, by name.
const std::map<std::string, std::string>& embedded_texts();

/// Names of the shipped models.
std::vector<std::string> shipped_models();

/// `model`: the name of a shipped one, or the path of a file. `site_nm`: what its parts `sites` are made of;
/// none needed where it has none. Throws smlm::Error (usage) that names file, line and key.
fitting::GeometricModel load_model(const std::string& model, const Eigen::Matrix3Xd& site_nm);

/// The same from text.
fitting::GeometricModel parse_model(const std::string& text, const std::string& where,
                                    const Eigen::Matrix3Xd& site_nm);

/// `name=value` or `name`: holds a parameter at the value, or at its start. Throws smlm::Error (usage).
void hold_parameter(fitting::GeometricModel& model, const std::string& assignment);

}  // namespace polar::pipeline
