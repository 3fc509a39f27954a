// Small pieces that several stages need: a first template under given poses, its score on kept-out
// localisations.
#pragma once

#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/mixture.hpp"
#include "problem.hpp"

namespace polar {

/// Fewer localisations say nothing about a pose.
constexpr int kFewestLocalisations = 4;
std::string too_few_localisations();

/// Of the uniform outlier class: over a ball (planar: a disc) half again as large as a particle.
double outlier_density(bool planar);

/// `centres` centres of equal weight at localisations drawn from `subsets` of the views `which`, moved by
/// `pose` (one for each of `which`).
Mixture scattered_mixture(const Problem& problem, const Subsets& subsets, const std::vector<int>& which,
                          const std::vector<Pose>& pose, int centres, std::uint64_t key);

}  // namespace polar
