// Starts are hypotheses, and they compete: short runs of each, the better half goes on, the best by the
// likelihood of localisations that were kept out of the fusion wins.
#pragma once

#include <string>
#include <vector>

#include "ab_initio.hpp"
#include "polar/core/progress.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

struct StartsOutcome {
  Hypothesis winner;
  std::vector<int> which;  // views its poses belong to
  std::vector<StartReport> report;
};

StartsOutcome compete(const Problem& problem, const std::vector<std::string>& starts, Progress& progress);

}  // namespace polar
