// Particles become views: a robust centre for each, one robust scale for all. The paper divides by the
// largest radius of any view, so one stray localisation would shrink every particle.
#pragma once

#include "polar/core/view.hpp"
#include "smlm/particle_set.hpp"

namespace polar {

struct PrepareOptions {
  double trim = 0.1;  // share left out at each end of an axis before the mean: the robust centre
  double radius_quantile =
      0.95;  // of a particle's distances from its centre; the scale is their median over particles
};

/// One view a particle, in the same order, empty particles as empty views. Throws smlm::Error (input) when no
/// particle has an extent.
Views prepare_views(const smlm::ParticleSet& particles, const PrepareOptions& options = {});

}  // namespace polar
