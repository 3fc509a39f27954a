// How many centres does the structure have? Nearby centres are merged at growing distances and the likelihood
// of localisations kept out of the fit decides: a few sites, or the many centres of a continuous surface.
#pragma once

#include "polar/fusion/mixture.hpp"

namespace polar {

/// Centres nearer than `distance` to a heavier one are merged into it (weighted mean), heaviest first.
Mixture merged(const Mixture& mixture, double distance);

}  // namespace polar
