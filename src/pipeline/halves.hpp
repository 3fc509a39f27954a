// `output.resolution: halves`: two halves of the particles, registered as if the other did not exist.
#pragma once

#include <cstdint>
#include <vector>

#include "polar/pipeline/run.hpp"
#include "polar/results/results.hpp"
#include "smlm/particle_set.hpp"

namespace polar::pipeline {

/// Splits the particles of the whole result by a keyed draw (equal numbers), registers each half with a seed
/// of its own, aligns the half maps at the end, lays them onto the whole and correlates them; the same again
/// for noise_particles. Fewer than four particles cannot be split: the report is then empty.
ResolutionReport resolve_halves(const Results& whole, const RegistrationOptions& options, Progress& progress,
                                Checkpoint& checkpoint, const Engine& engine);

/// Which particles are in the second half. Copies of a measurement (smlm::find_repetitions) are in the same
/// one: two halves that share data agree on anything.
std::vector<bool> second_half(const smlm::ParticleSet& set, std::uint64_t seed);

}  // namespace polar::pipeline
