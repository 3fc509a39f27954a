// Particles become views: a robust centre for each, one robust scale for all. The paper divides by the
// largest radius of any view, so one stray localisation would shrink every particle.
#pragma once

#include "polar/core/view.hpp"
#include "smlm/particle_set.hpp"

namespace polar {

struct PrepareOptions {
  double radius_factor =
      1.4;  // times the median distance from the centre is a particle's radius: robust to 49 % strays
};

/// One view a particle, in the same order, empty particles as empty views. Throws smlm::Error (input) when no
/// particle has an extent.
Views prepare_views(const smlm::ParticleSet& particles, const PrepareOptions& options = {});

}  // namespace polar
