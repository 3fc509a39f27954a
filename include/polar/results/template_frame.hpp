// The template in a frame of its own: what a registration ends in is turned any way.
#pragma once

#include <Eigen/Core>

#include "polar/core/pose.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// To the frame that the structure itself suggests: where a symmetry is known, its canonical one (main axis
/// along z); else the centroid and the principal axes of the fused template, along z the one whose width
/// differs most from the other two (the axis of a ring or of a rod), along x the wider of the others, both
/// towards the side that reaches farther out. Planar: about z only. The same template gives the same frame
/// however it was turned before, but where two widths or two sides are alike.
Pose own_frame_from_template(const Registration& registration, bool planar);

/// Moves the template, the poses with their covariances, and the symmetry into another frame.
void move_template(Registration& registration, const Pose& new_from_old);

}  // namespace polar
