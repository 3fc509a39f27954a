// What a run says about the group of its template.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "polar/registration/symmetry.hpp"

namespace polar::pipeline {

/// One line of the printed summary.
std::string symmetry_line(const Symmetry& symmetry, double scale_nm);

/// The section `symmetry` of summary.json.
nlohmann::json symmetry_json(const Symmetry& symmetry, double scale_nm);

}  // namespace polar::pipeline
