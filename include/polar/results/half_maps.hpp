// From two independent results to their Fourier shell correlation.
#pragma once

#include <cstdint>

#include "polar/results/resolution.hpp"
#include "polar/results/results.hpp"

namespace polar {

/// Moves the second result's superparticle onto the first one's template, as one rigid map: the likelihood of
/// the map, searched over all rotations. No particle of one half has any say in the other. first_from_second,
/// nm.
Pose align_maps(const Results& first, const Results& second, std::uint64_t seed);

/// Aligns, draws both superparticles in one cube (calibrated, localisations at its faces left out) and
/// correlates. A half without an accepted particle leaves the resolution NaN.
HalfMaps compare_half_maps(const Results& first, const Results& second, std::uint64_t seed);

/// The control's input: every localisation's place is drawn from a Gaussian about its particle's mean, as
/// wide as the particle (root mean square, the same along every axis), keyed by (seed, particle). All else
/// stays, uncertainties too.
smlm::ParticleSet noise_particles(smlm::ParticleSet particles, std::uint64_t seed);

}  // namespace polar
