// Rows whose numbers lie within given bounds.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <string>

#include "smlm/localisation_table.hpp"

namespace smlm {

/// From the first to the second, both included.
using Bounds = std::array<double, 2>;
constexpr Bounds kUnbounded = {-std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::infinity()};

/// Leaves out the rows that lie outside of any of the bounds, and counts them in table.rejected by the first
/// one that they miss. A key is x_nm, y_nm, z_nm, sigma_x_nm, sigma_y_nm, sigma_z_nm, sigma_xy_nm (the root
/// mean square of x and y), or the heading or quantity (photons, background, frame) of a column that is kept.
/// A value that is no number is outside. Throws Error(input), naming the columns that there are, where a key
/// is none of them.
void filter_rows(LocalisationTable& table, const std::map<std::string, Bounds>& filters);

}  // namespace smlm
