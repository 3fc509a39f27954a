// What MINFLUX files of all kinds have in common once their numbers are out of them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "../column_arrays.hpp"

namespace smlm::readers {

/// The last iteration of each valid measurement.
struct MinfluxRows {
  std::vector<std::array<double, 3>> location_m;
  bool planar = false;             // loc has two numbers; location's third is 0
  std::vector<double> trace;       // tid
  std::vector<ColumnArray> extra;  // one value a row each
  std::vector<std::uint64_t> row;  // 1-based in the source
  std::uint64_t invalid = 0;       // rows left out because vld is false
  std::uint64_t first_invalid = 0;
};

/// Metres to nm, z times options.minflux_z_factor (which is said), and as uncertainty the standard deviation
/// of the localisations of the same trace, which is the only measure of precision these files allow; traces
/// of fewer than five localisations take the median over the others.
LocalisationTable build_minflux_table(const std::string& path, MinfluxRows rows, const ReadOptions& options);

}  // namespace smlm::readers
