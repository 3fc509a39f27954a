// The superparticle as the template of the latent loss. D(z) of a small decoder misses the structure by
// several times the noise, and the loss then hardly tells a wrong basin from the right one; the localisations
// of well-registered views, moved into the template's frame, show what the data show.
#pragma once

#include <vector>

#include "descent.hpp"

namespace polar {

/// `count` points: localisations of `which` views drawn by lot, each moved to the mean of its neighbours
/// under its own noise, without those that other views support least. `draw` keys the lot.
Eigen::Matrix3Xf fused_template(const LatentViews& views, const std::vector<int>& which,
                                const std::vector<Pose>& view_from_template, int count, std::uint64_t seed,
                                int draw);

/// The `share` of views that are not empty and have the lowest losses, ascending.
std::vector<int> best_views(const LatentViews& views, const std::vector<double>& loss, double share);

}  // namespace polar
