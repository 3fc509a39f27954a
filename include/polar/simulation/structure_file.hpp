// Structures from files: any set of points can be simulated.
#pragma once

#include <cstdint>
#include <string>

#include "polar/simulation/structure.hpp"

namespace polar {

struct StructureFile {
  std::string path;   // .h5 (`points`: shape x point x 3, attribute `scale`), a table of x, y, z (read as any
                      // localisation table; without a header three columns in nm) or .ply (text)
  std::string label;  // .h5: takes the shape of this `name`, or the index-th with this `label`; empty: of all
  std::uint64_t index = 0;
  double radius_nm =
      0;  // scaled so that the farthest point from the mean has this distance; 0: as it is, in nm
};

/// The points of the file about their mean. Throws smlm::Error (input).
Structure read_structure(const StructureFile& file);

}  // namespace polar
