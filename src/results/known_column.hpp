// Columns of the input that other programs' files ask for, found by what they mean.
#pragma once

#include "smlm/kept_column.hpp"

namespace polar::results {

/// The column with this normalised name (see smlm::Heading) in nm; null where none has.
const smlm::ExtraColumn* find_length_nm(const smlm::LocalisationTable& table, const char* name);

/// The column's value in a row; `otherwise` where there is no column, or the number is none, or negative.
double value_or(const smlm::ExtraColumn* column, std::size_t row, double otherwise);

}  // namespace polar::results
