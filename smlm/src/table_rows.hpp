// Some rows of a table.
#pragma once

#include <cstdint>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

/// Leaves only these rows, in this order. Particles keep their names, also those without a row.
void take_rows(LocalisationTable& table, const std::vector<std::uint32_t>& rows);

/// Standard deviation of a localisation along x and y, one value for both: the root mean square.
double lateral_sigma_nm(const Covariance& covariance);

}  // namespace smlm
