// Whether two starts ended alike: what began at random twice and came to the same poses is no accident.
#pragma once

#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// The largest share of views whose poses one common rotation takes from one set to the other, within 15
/// degrees. Both hold template_from_view of the same views, each in a frame of its own.
double agreement(const std::vector<Pose>& a, const std::vector<Pose>& b);

/// The same for a structure that is known to be symmetric: views count too that the common motion takes to
/// where the template of `a` looks the same. A structure that is not known to be may only be nearly so, and
/// two starts may then have turned the same views wrongly.
double agreement_modulo_symmetry(const Mixture& template_of_a, bool planar, const std::vector<Pose>& a,
                                 const std::vector<Pose>& b);

}  // namespace polar
