// The frame that the page draws the average in.
#pragma once

#include <string>

#include "polar/core/pose.hpp"
#include "polar/report/record.hpp"

namespace polar::report {

struct DrawingFrame {
  Pose drawn_from_template;  // nm
  bool axial = false;        // z is an axis that the structure winds about
  std::string sentence;      // how it was chosen
};

/// With a symmetry axis: that axis along z. Else, in space, the principal axes of the superparticle: z the
/// one whose extent differs most from the other two. Planar: the template's own frame about its middle.
DrawingFrame drawing_frame(const RunRecord& record);

}  // namespace polar::report
