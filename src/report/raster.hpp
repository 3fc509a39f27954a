// Planes of a volume as pictures.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "polar/results/render.hpp"

namespace polar::report {

/// What a plane shows: u to the right, v upwards, row 0 at the bottom.
struct Raster {
  std::size_t width = 0, height = 0;
  double pixel_nm = 1;
  std::array<double, 2> origin_nm = {0, 0};  // of the first pixel's centre
  std::vector<double> value;

  double largest() const;
};

/// Which axes of the volume go to the right and up; the third is summed over [begin, end) of its voxels.
struct Plane {
  std::size_t across, up, through;
  const char* name;
};
constexpr Plane kTopView = {0, 1, 2, "xy"}, kFrontView = {0, 2, 1, "xz"}, kSideView = {1, 2, 0, "yz"};

Raster summed(const Volume& volume, const Plane& plane, std::size_t begin, std::size_t end);
inline Raster projected(const Volume& volume, const Plane& plane) {
  return summed(volume, plane, 0, volume.size[plane.through]);
}

/// A colour's share in a picture, each 0 to 1.
using Tint = std::array<double, 3>;

/// Black to white through red and yellow, `brightest` and above white. Weak parts are brightened.
std::string heat_png(const Raster& raster, double brightest);

/// Rasters of one size added in their colours.
std::string tinted_png(const std::vector<Raster>& rasters, const std::vector<Tint>& tints,
                       const std::vector<double>& brightest);

/// The picture with a scale bar and the names of its axes, and the legend of its colours.
std::string picture_svg(const Raster& raster, const std::string& png, const char* axes,
                        const std::string& label,
                        const std::vector<std::pair<std::string, std::string>>& legend = {});

}  // namespace polar::report
