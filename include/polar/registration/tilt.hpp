// How far the particles of a registration really lie from upright: the width of the tilt prior, estimated
// again.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "polar/registration/registration.hpp"

namespace polar {

struct TiltSpread {
  double std_deg = 0;         // about either axis
  std::size_t particles = 0;  // accepted ones, from which it is
};

/// From the median of the accepted views' squared angles, less what their poses' own errors add: wrong poses
/// do not widen it. Upright is the line that suits the views' z best in the template's frame, so turning the
/// template changes nothing and upside down is upright. Nothing where no view is accepted.
std::optional<TiltSpread> tilt_spread(const std::vector<RegisteredView>& view);

}  // namespace polar
