// The rotation group of the fused template: found, or imposed (registration.symmetry).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"

namespace polar {

/// One group that was tried. `gain`: held-out log density per localisation above that of the template without
/// a group; negative where the structure lacks the group. `gain_std`: its standard error over views.
struct SymmetryTrial {
  std::string group;
  double similarity = 0;  // of the template and its images: 1 its own, 0 that of any turn
  double gain = 0, gain_std = 0;
};

/// Lengths are in units of Normalisation::scale_nm.
struct Symmetry {
  bool asked = false;   // named in the configuration; else found
  bool in_use = false;  // template and poses have it; else the average without it explains more
  /// As core/symmetry_group.hpp names it; C1: none. Where no turn about an axis can be told from another:
  /// Cinf, Dinf (with two-fold axes across), or SO3, a sphere.
  std::string group = "C1";
  /// To the group's own frame: main axis z, two-fold axes of D_n along x, T, O and I along the cube's axes.
  /// The identity where the group is imposed.
  Pose canonical_from_template;
  double gain = 0, gain_std = 0;     // of that group, see SymmetryTrial
  std::vector<SymmetryTrial> tried;  // largest groups first
  /// The images of the template's densest spot, one a symmetric unit, template frame; none where the group is
  /// continuous or C1. A localisation belongs to the nearest.
  Eigen::Matrix3Xd unit;
  std::vector<double> unit_share;  // of the superparticle's localisations; even labelling: all the same

  Eigen::Vector3d axis() const { return canonical_from_template.rotation.row(2).transpose(); }
  Eigen::Vector3d centre() const { return canonical_from_template.inverse().translation; }
};

}  // namespace polar
