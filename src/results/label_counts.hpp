// Which places of a structure carry a label in each particle, and how many localisations a label has:
// sampled, so that a doubtful place counts as much as it is probable and no more.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "polar/results/labelling.hpp"
#include "smlm/localisation_table.hpp"

namespace polar::results {

/// A place that could have made a localisation, and the localisation's density there.
struct Candidate {
  std::uint32_t place = 0;
  double density = 0;
};

/// The candidates of every localisation of a particle; none: only the background is left.
using ParticleCandidates = std::vector<std::vector<Candidate>>;

/// Of every particle that has localisations, in the order of the particles. `density`: of a localisation with
/// that covariance and position at that place; 0: it cannot be its.
std::vector<ParticleCandidates> candidates_of(
    const smlm::LocalisationTable& table, std::size_t places,
    const std::function<double(const Eigen::Matrix3d&, const Eigen::Vector3d&, std::size_t)>& density);

/// A particle's localisations come from labels and from the background. A place has a label with a
/// probability that all places share; a label has one localisation or more, their number from a distribution
/// that all labels share; the background has a Poisson number of them. These three are found with the
/// particles' own assignments (Gibbs sampling of which localisation is whose, and stochastic approximation of
/// the likeliest numbers: B. Delyon, M. Lavielle, E. Moulines, Ann. Statist. 27, 94-128, 1999). So a stray
/// localisation near a neighbour's label is worth as much as single localisations are frequent among labels.
/// `background`: density of what belongs to no place; `background_share`: of the localisations, a first
/// guess.
PlaceCounts count_labels(const std::vector<ParticleCandidates>& particles, std::size_t places,
                         double background, double background_share);

}  // namespace polar::results
