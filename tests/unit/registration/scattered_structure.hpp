#pragma once

#include <cmath>

#include "polar/core/rng.hpp"
#include "polar/simulation/structure.hpp"

namespace polar {

// Labels scattered in a ball: no symmetry, and every half of it can be told from every other.
inline Structure scattered_structure(int sites) {
  Structure s;
  s.site_nm.resize(3, sites);
  KeyedRandom random(13, 0, 2);
  for (int k = 0; k < sites; ++k) s.site_nm.col(k) = 100 * std::cbrt(random.uniform()) * random.direction();
  return s;
}

}  // namespace polar
