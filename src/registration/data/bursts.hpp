// Localisations of one label share its place: where some of them are fitted, the others say nothing new. A
// burst is what lies within each other's uncertainty; it is fitted or held out as a whole.
#pragma once

#include <cstdint>
#include <vector>

#include "polar/core/view.hpp"

namespace polar {

/// The burst of every localisation, numbered from 0. `order`: in which they become first members; `distance`:
/// Mahalanobis, under the sum of both covariances, from the first member of a burst to the others.
std::vector<int> bursts(const View& view, const std::vector<std::uint32_t>& order, double distance,
                        bool planar);

}  // namespace polar
