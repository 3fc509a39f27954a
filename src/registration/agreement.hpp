// Whether two starts ended alike: what began at random twice and came to the same poses is no accident.
#pragma once

#include <vector>

#include "polar/core/pose.hpp"

namespace polar {

/// The largest share of views whose poses one common rotation takes from one set to the other, within 15
/// degrees. Both hold template_from_view of the same views, each in a frame of its own.
double agreement(const std::vector<Pose>& a, const std::vector<Pose>& b);

}  // namespace polar
