// Points out of a table: where they are, not how well that is known.
#pragma once

#include <array>
#include <set>
#include <string>
#include <vector>

#include "smlm/read_options.hpp"

namespace smlm {

struct Points {
  std::vector<std::array<double, 3>> position_nm;  // z = 0 where there is none
  bool planar = false;                             // there is no z, or nothing in it
  std::vector<std::string> warnings;
  std::set<std::string> keys_used;  // of the input section
};

/// The positions in a table that any reader understands, by the same rules for headers, units and decimals as
/// a table of localisations; whatever it says of particles and uncertainties is ignored.
Points read_points(const std::string& path, const ReadOptions& options);

}  // namespace smlm
