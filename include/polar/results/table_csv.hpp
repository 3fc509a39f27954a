// Localisation tables as comma-separated text with ThunderSTORM-like headings: the exchange format of last
// resort that everything reads.
#pragma once

#include <string>

#include "smlm/localisation_table.hpp"

namespace polar {

/// Header `x [nm],y [nm],z [nm],uncertainty_x [nm],...,particle,<every further column>`; a table with
/// off-diagonal covariances has sigma_xx [nm^2], sigma_xy [nm^2], ... instead; a planar one has no z. Lengths
/// with four decimals, in any locale.
std::string format_table_csv(const smlm::LocalisationTable& table);

}  // namespace polar
