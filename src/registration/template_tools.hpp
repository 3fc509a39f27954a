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

/// Two temperaments. Crowded: outliers such as strands are expected, so centres begin on what views share and
/// weak ones are sown anew; else every centre is given time, which sparse particles need.
double first_outlier_fraction(bool crowded);
MaximisationOptions fusion_options(bool crowded, double width);

/// `centres` centres of equal weight at localisations drawn from `subsets` of the views `which`, moved by
/// `pose` (one for each of `which`).
Mixture scattered_mixture(const Problem& problem, const Subsets& subsets, const std::vector<int>& which,
                          const std::vector<Pose>& pose, int centres, std::uint64_t key);

/// Mean over views of the mean log density of `held_out`, template width `width`.
double held_out_score(const Problem& problem, const Subsets& held_out, const std::vector<int>& which,
                      const Mixture& mixture, const std::vector<Pose>& pose, double width);

/// Mean over localisations of the log density of `held_out` under a noise model, all views. `cut`: by
/// planes.
double held_out_score(const Problem& problem, const Mixture& mixture, const std::vector<Pose>& pose,
                      const NoiseModel& noise, bool cut);

/// Mean over views of what a localisation gains where its view is taken as cut (polar/fusion/cuts.hpp).
double mean_gain_of_cuts(const Problem& problem, const Mixture& mixture, const std::vector<Pose>& pose);

/// From means per view, those of `which`, to the mean over the localisations `judged`.
double mean_per_localisation(const std::vector<double>& mean_of_view, const std::vector<int>& which,
                             const Subsets& judged);

}  // namespace polar
