// Outlines: where a raster passes a level.
#pragma once

#include <array>
#include <vector>

#include "raster.hpp"

namespace polar::report {

/// Segments in nm by marching squares, linear between pixels.
std::vector<std::array<double, 4>> contour(const Raster& raster, double level);

}  // namespace polar::report
