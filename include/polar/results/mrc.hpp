// Densities as maps for ChimeraX, RELION, IMOD and whatever else reads electron microscopy's format.
#pragma once

#include <string>

#include "polar/results/render.hpp"

namespace polar {

/// MRC2014 (A. Cheng et al., MRC2014: extensions to the MRC format header for electron cryo-microscopy and
/// tomography, J. Struct. Biol. 192, 146-150, 2015), little endian, 32-bit floats, x fastest. Voxel size and
/// origin (of the first voxel's centre) are in the format's ångström, ten to a nanometre; a planar volume is
/// an image. Throws smlm::Error (io).
void write_mrc(const std::string& path, const Volume& volume);

}  // namespace polar
