// Which sites carry labels together.
#pragma once

#include <vector>

#include "displacements.hpp"
#include "polar/fitting/modes.hpp"

namespace polar::fitting {

/// Fills occupancies and their modes: principal components of the sites' occupancies over particles, held
/// against independent sites of the same occupancies.
void add_occupancy_modes(ModesReport& report, const std::vector<std::vector<Label>>& labels,
                         const ModesOptions& options);

/// Shares of the variance above control, of all modes together.
void share_among(std::vector<Mode>& modes);

}  // namespace polar::fitting
