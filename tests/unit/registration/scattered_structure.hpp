#pragma once

#include <cmath>

#include "polar/core/rng.hpp"
#include "polar/simulation/simulate.hpp"

namespace polar {

// Labels scattered in a ball: no symmetry, and every half of it can be told from every other.
inline Structure scattered_structure(int sites) {
  Structure s;
  s.site_nm.resize(3, sites);
  KeyedRandom random(13, 0, 2);
  for (int k = 0; k < sites; ++k) s.site_nm.col(k) = 100 * std::cbrt(random.uniform()) * random.direction();
  return s;
}

// Sixteen particles of so many localisations with the same noise along every axis.
inline SimulationOptions sixteen_particles(double localisations) {
  SimulationOptions o;
  o.particles = 16;
  o.sampling = "points";
  o.points = {localisations, localisations};
  o.sigma_xy_nm = {2, 2};
  o.sigma_z_factor = {1, 1};
  o.label_size_nm = 0;
  o.cramer_rao = false;
  return o;
}

}  // namespace polar
