// Columns of the input that are kept beside positions and uncertainties, found by what they mean.
#pragma once

#include <string>

#include "smlm/column.hpp"
#include "smlm/localisation_table.hpp"

namespace smlm {

/// The first kept column of numbers that means `quantity`; null where none does.
const ExtraColumn* find_column(const LocalisationTable& table, Quantity quantity);

/// The kept column that a user calls `name`: by its heading, with or without its unit, else by the quantity
/// of that name; null where none is.
const ExtraColumn* find_named_column(const LocalisationTable& table, const std::string& name);

}  // namespace smlm
