// aligned.ply: the superparticle as a point cloud for MeshLab, CloudCompare, Blender, Open3D and the like.
#pragma once

#include <string>

#include "smlm/localisation_table.hpp"

namespace polar {

/// Binary little-endian PLY, one vertex a localisation. Properties: x, y, z (float, nm, template frame);
/// sigma_x, sigma_y, sigma_z (float, nm: square roots of the rotated covariance's diagonal; sigma_z is 0 in
/// planar tables); particle (int, its row in poses.csv from 0); weight (float: the information of the
/// localisation relative to the most precise one, (sigma_min / sigma)^2 with sigma the geometric mean over
/// the axes). Throws smlm::Error (io).
void write_ply(const std::string& path, const smlm::LocalisationTable& table);

}  // namespace polar
