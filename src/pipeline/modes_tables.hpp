// What the search for modes writes, as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "polar/fitting/modes.hpp"

namespace polar::pipeline {

/// Standard deviations at which a mode's average is written.
const std::vector<double>& shown_scores();

/// Sites at a score of a position mode.
Eigen::Matrix3Xd sites_at(const fitting::ModesReport& report, const fitting::Mode& mode, double score);

std::string modes_csv(const fitting::ModesReport& report);
std::string scores_csv(const fitting::ModesReport& report, const std::vector<std::string>& particle);
std::string mode_sites_csv(const fitting::ModesReport& report);
nlohmann::json modes_json(const fitting::ModesReport& report);
std::vector<std::string> modes_lines(const fitting::ModesReport& report);

}  // namespace polar::pipeline
