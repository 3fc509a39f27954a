// Particles that are too small, too large, too empty or too full to be one copy of the structure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smlm/particle_set.hpp"
#include "smlm/row_filter.hpp"

namespace smlm {

struct ParticleLimits {
  Bounds localisations = kUnbounded;
  Bounds radius_nm = kUnbounded;  // root mean square distance from the particle's centroid
};

/// One sentence per fault, each starting with its key; empty when the options can be used.
std::vector<std::string> violations(const ParticleLimits& limits);

/// A particle outside of the limits, and why.
struct UnfitParticle {
  std::size_t particle = 0;  // index into ParticleSet::particles
  std::string reason;
};

/// In the order of the particles. One without an extent (a single localisation) is outside of no radius.
std::vector<UnfitParticle> unfit_particles(const ParticleSet& set, const ParticleLimits& limits);

/// Root mean square distance of some rows from their centroid; NaN for fewer than two.
double radius_nm(const LocalisationTable& table, const std::vector<std::uint32_t>& rows);

}  // namespace smlm
