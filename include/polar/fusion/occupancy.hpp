// Which centres a view really shows. Labels are missing and blink: a particle shows part of the sites, each
// several times, and a crop shows part of a surface. Every view gets weights of its own, the posterior mean
// under a Dirichlet prior around the template's weights w:
//   pi_ik = (n_ik + a K w_k) / (n_i + a K),   n_ik = sum_j r_jk at the present pose.
#pragma once

#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// The factors pi_ik / w_k of every view, from the localisations of `evidence` at poses template_from_view.
/// `strength` a is in localisations a centre: small trusts the view, infinite gives no factors. Counts are
/// pooled over centres within `reach` of each other: a view tells sites apart no better than its uncertainty.
/// Responsibilities are iterated a few times.
std::vector<std::vector<float>> occupancy(const Mixture& mixture, const FusionData& evidence,
                                          const std::vector<Pose>& template_from_view, double strength,
                                          double reach);

/// n_ik, the localisations of view i that are expected to be of centre k; none of a view without any.
std::vector<std::vector<double>> attributed(const Mixture& mixture, const FusionData& data,
                                            const std::vector<Pose>& template_from_view);

/// The strength under which the views' counts of centres, pooled in the same way, are likeliest: evidence of
/// the Dirichlet-multinomial, no localisation needs to be held out. Infinite where every view shows the
/// template as it is, up to chance.
double likeliest_strength(const Mixture& mixture, const FusionData& data,
                          const std::vector<Pose>& template_from_view, double reach);

/// Share of the template's weight that a view shows: sum_k min(pi_ik, w_k); 1 without factors.
double shown_share(const Mixture& mixture, const std::vector<float>& factor);

}  // namespace polar
