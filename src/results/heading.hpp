#pragma once

#include <string>

#include "smlm/localisation_table.hpp"

namespace polar::results {

/// A kept column's name with its unit in brackets, unless the name says it already.
inline std::string heading(const smlm::ExtraColumn& column) {
  const bool named = column.unit.empty() || column.name.find(column.unit) != std::string::npos;
  return named ? column.name : column.name + " [" + column.unit + "]";
}

}  // namespace polar::results
