// The finite rotation groups that a structure can have, as lists of rotations in the structure's own
// frame: main axis along z, two-fold axes of D_n along x, T, O and I along the cube's axes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace polar {

/// All rotations of `name`: none (or C1), C<n>, D<n> (n up to 360), T (12), O (24), I (60). The identity
/// comes first. Throws smlm::Error (usage) for any other name.
std::vector<Eigen::Matrix3d> symmetry_rotations(const std::string& name);

/// Whether no image g * rotation is nearer to the identity: of every orbit one is (two on its border). What a
/// search over the poses of a symmetric template looks at.
bool in_asymmetric_unit(const std::vector<Eigen::Matrix3d>& group, const Eigen::Matrix3f& rotation);

/// Whether it has a list for that name.
bool is_symmetry_group(const std::string& name);

}  // namespace polar
