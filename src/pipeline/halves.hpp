// `output.resolution: halves`: two halves of the particles, registered as if the other did not exist.
#pragma once

#include "polar/pipeline/run.hpp"
#include "polar/results/resolution.hpp"
#include "smlm/particle_set.hpp"

namespace polar::pipeline {

/// Splits the particles by a keyed draw (equal numbers), registers each half with a seed of its own, aligns
/// the half maps at the end and correlates them; the same again for noise_particles. Fewer than four
/// particles cannot be split: the report is then empty.
ResolutionReport resolve_halves(const smlm::ParticleSet& particles, const RegistrationOptions& options,
                                Progress& progress, Checkpoint& checkpoint, const Engine& engine);

}  // namespace polar::pipeline
