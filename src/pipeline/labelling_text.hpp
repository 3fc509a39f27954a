// What a run says about the sites of its template and how many of them carry a label.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "polar/results/labelling.hpp"
#include "polar/results/sites.hpp"

namespace polar::pipeline {

/// Lines of the printed summary; none where the template is not discrete.
std::vector<std::string> labelling_lines(const DiscreteSites& sites,
                                         const std::optional<Labelling>& labelling);

/// The sections `sites` and `labelling` of summary.json.
void add_labelling(nlohmann::json& summary, const DiscreteSites& sites,
                   const std::optional<Labelling>& labelling);

}  // namespace polar::pipeline
