// What a run says about the sites of its template and how many of them carry a label.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "polar/results/labelling.hpp"
#include "polar/results/sites.hpp"

namespace polar::pipeline {

/// Lines of the printed summary; none where nothing is counted (null).
std::vector<std::string> labelling_lines(const DiscreteSites& sites, const Labelling* labelling);

/// The sections `sites` and `labelling` of summary.json.
void add_labelling(nlohmann::json& summary, const DiscreteSites& sites, const Labelling* labelling);

}  // namespace polar::pipeline
