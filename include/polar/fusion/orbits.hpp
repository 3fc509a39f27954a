// A template that has a rotation group exactly: every centre comes with its images. The group's elements fix
// the origin of the template frame (core/symmetry_group.hpp); an empty list is no symmetry.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/fusion/mixture.hpp"

namespace polar {

using RotationGroup = std::vector<Eigen::Matrix3d>;  // closed, the identity first

/// Angle between two rotations template_from_view, the nearest of their images.
double angle_modulo(const RotationGroup& group, const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// A point nearer than `distance` to axes of the group, moved onto them: it has fewer images than the group
/// elements.
Eigen::Vector3d onto_axes(Eigen::Vector3d x, const RotationGroup& group, double distance);

/// For every orbit of the centres the index of g times its first centre, one for each element of the group in
/// its order. A centre on an axis has fewer images than the group elements: indices then occur several times.
/// The centres must be closed under the group.
std::vector<std::vector<Eigen::Index>> orbits(const Eigen::Matrix3Xf& centre, const RotationGroup& group);

/// Makes positions exact images of each other and weights equal within every orbit; takes away rounding.
void snap_to_orbits(Mixture& mixture, const RotationGroup& group,
                    const std::vector<std::vector<Eigen::Index>>& orbits);

/// The average of the mixture over the group, with images nearer than `distance` to one another merged,
/// densest spot first: what several copies say about one site becomes one centre. At most 4,096 centres:
/// `distance` grows until they suffice. Closed under the group and sorted into blocks.
Mixture symmetrised(const Mixture& mixture, const RotationGroup& group, double distance);

}  // namespace polar
