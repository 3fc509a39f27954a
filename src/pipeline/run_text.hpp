// What a run says of itself: the lines of its printed summary, and summary.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "polar/results/results.hpp"
#include "polar/results/strangers.hpp"

namespace polar::pipeline {

/// Rejected particles by reason, the most frequent first.
std::vector<std::pair<std::size_t, std::string>> rejections(const Results& r);

/// `tilt_deg`: of the prior, 0 where there is none.
std::vector<std::string> describe(const Results& r, double tilt_deg, const std::vector<Stranger>& unlike,
                                  const std::string& directory, double seconds);

/// `files` that were written, `lines` as printed. What was counted in labels is added elsewhere.
nlohmann::json summary_json(const Results& r, const std::vector<Stranger>& unlike,
                            const std::vector<std::string>& lines, const std::vector<std::string>& files,
                            double seconds);

}  // namespace polar::pipeline
