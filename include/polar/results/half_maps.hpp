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
/// correlates. Where the result of all particles is given, the cube lies in its frame, so that half maps and
/// template can be laid over one another. A half without an accepted particle leaves the resolution NaN.
HalfMaps compare_half_maps(const Results& first, const Results& second, std::uint64_t seed,
                           const Results* whole = nullptr);

/// Two tables of one frame, drawn in one cube (as the options say, localisations at its faces left out), and
/// what they have in common. `most_voxels` along an edge, a product of 2, 3 and 5; 0: as compare_half_maps
/// takes them.
struct DrawnShells {
  double voxel_nm = 0;
  Volume first, second;
  FourierShells shells;
};
DrawnShells shells_between(const smlm::LocalisationTable& a, const RenderOptions& drawing_a,
                           const smlm::LocalisationTable& b, const RenderOptions& drawing_b,
                           std::size_t most_voxels = 0);

/// The control's input: every localisation's place is drawn from a Gaussian about its particle's mean, as
/// wide as the particle (root mean square, the same along every axis), keyed by (seed, particle). All else
/// stays, uncertainties too.
smlm::ParticleSet noise_particles(smlm::ParticleSet particles, std::uint64_t seed);

}  // namespace polar
