// Starts are hypotheses, and they compete: a short run of each on a few views, the best few are then
// registered on all views, and the best of those by the likelihood of localisations that were kept out of the
// fusion wins. Where the best two random starts come to the same poses they have settled it.
#pragma once

#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/registration/checkpoint.hpp"
#include "polar/registration/register.hpp"
#include "rounds.hpp"

namespace polar {

struct StartsOutcome {
  RoundState winner;  // registered on all views
  std::vector<StartReport> report;
  double agreement = 0;   // Registration::agreement
  bool finished = false;  // false: cancelled
};

/// `model`: of the start `polar`, null where it is not wanted.
StartsOutcome compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                      const SearchGrid& grid, const RoundOptions& rounds, Progress& progress,
                      Checkpoint& checkpoint);

}  // namespace polar
