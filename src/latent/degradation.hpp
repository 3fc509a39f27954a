// How much of the structure a view shows and how much of it is foreign, read off a first registration. The
// paper leaves this open; too little is the safe side, because a mask too large fits any pose.
#pragma once

#include "descent.hpp"

namespace polar {

/// Under the template `points`. Sets the ratios that `options` leave to be estimated, and the draws that
/// depend on them.
void estimate_degradation(const Autoencoder& model, const Eigen::Matrix3Xf& points,
                          const std::vector<Pose>& view_from_template, const LatentOptions& options,
                          LatentViews& views);

}  // namespace polar
