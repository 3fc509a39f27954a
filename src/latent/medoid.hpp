// First templates (paper III.E, eq. of z_init).
#pragma once

#include <vector>

#include "polar/latent/loss.hpp"

namespace polar {

/// Views whose latent vectors may start a template: the medoid, then of the half of the views that lie most
/// centrally those farthest from the ones taken. Among thousands of views a fixed number is compared.
std::vector<int> medoids(const LatentViews& views, int most);

}  // namespace polar
