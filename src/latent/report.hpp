// What a latent registration hands on, in units of the views.
#pragma once

#include <vector>

#include "descent.hpp"
#include "polar/latent/latent_registration.hpp"

namespace polar {

/// Template and poses of `state`, the second-best basins, ratios and covariances.
void report(const Autoencoder& model, const LatentViews& views, const Eigen::Matrix3Xf& points,
            const PosedViews& state, const std::vector<DescendedPose>& second, LatentRegistration& out);

}  // namespace polar
