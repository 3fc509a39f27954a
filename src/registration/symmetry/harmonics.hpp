// What the azimuths of a view's localisations about an axis say of the order of that axis, whatever the turn
// of the view about it. Labels that sit at random on n-fold sites have azimuths whose n-th harmonic does not
// vanish, and none below it that does not either.
#pragma once

#include <vector>

#include "../anneal/soft_poses.hpp"

namespace polar {

struct AxialHarmonic {
  int order = 0;
  /// Mean over views of the mean of cos(order (phi_j - phi_k)) over localisations of different bursts, less
  /// that of the two neighbouring orders, in standard errors over views.
  double significance = 0;
};

/// Orders 2 to the highest, most significant first. Poses are template_from_view with the axis along z
/// through the origin.
std::vector<AxialHarmonic> axial_harmonics(const Problem& problem, const SymmetryOptions& options,
                                           const std::vector<SoftPose>& pose, const std::vector<int>& which);

/// Turns every pose about z so that its harmonic of that order has phase 0: n-fold sites then lie on each
/// other.
void align_azimuths(const Problem& problem, int order, const std::vector<int>& which,
                    std::vector<SoftPose>& pose);

}  // namespace polar
