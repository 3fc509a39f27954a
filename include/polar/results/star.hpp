// Poses for RELION and the programs around it.
#pragma once

#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"

namespace polar {

/// A STAR file of the accepted particles. Block `optics`: one group with pixels of 1 nm. Block `particles`:
/// rlnTomoParticleName, rlnCoordinateX/Y/Z (where the template's origin lies in the table, in those pixels),
/// rlnOriginX/Y/ZAngst (0), rlnAngleRot/Tilt/Psi (degrees; RELION's Z-Y-Z angles, whose matrix
/// Rz(psi) Ry(tilt) Rz(rot) turns the reference onto the particle), rlnLogLikeliContribution, rlnOpticsGroup.
std::string format_star(const std::vector<PoseRow>& rows);

/// The angles (rot, tilt, psi) of a rotation that turns the reference onto the particle: x_particle = R x.
struct RelionAngles {
  double rot_deg = 0, tilt_deg = 0, psi_deg = 0;
};
RelionAngles relion_angles(const Eigen::Matrix3d& particle_from_reference);

}  // namespace polar
