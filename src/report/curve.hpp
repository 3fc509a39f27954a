// How the resolution falls with the number of particles.
#pragma once

#include <vector>

#include "section.hpp"

namespace polar::report {

struct ResolutionCurve {
  std::vector<double> particles, resolution_nm;  // NaN: nothing is resolved
};

/// Of an eighth, a quarter, half and all of the accepted particles in a random order, each split in two
/// halves that keep the poses of the run: an upper bound of what independent halves would resolve, since both
/// were registered to one template.
ResolutionCurve curve_of_common_poses(const Subject& subject);

}  // namespace polar::report
