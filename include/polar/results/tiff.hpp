// template.tif: the density as a stack for ImageJ and Fiji.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"

namespace polar {

/// 32-bit floating-point slices in the order of z, each with y downwards (row 0 is the smallest y),
/// calibrated in nm: resolution tags and an ImageJ description (unit, spacing, origin in pixels, display
/// range), so that ImageJ measures in the template frame. Values are those of Volume::density. Throws
/// smlm::Error (io).
/// Several volumes, in the same box, become the channels of a composite hyperstack.
void write_imagej_tiff(const std::string& path, const std::vector<Volume>& channels);

}  // namespace polar
