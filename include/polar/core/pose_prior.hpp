// What is known of orientations beforehand: particles lie upright to within so much, turned freely in the
// plane.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

namespace polar {

/// Which orientations are possible at all. The template's z is upright.
struct PosePrior {
  double tilt_rad = 0;  // standard deviation of a view's z from the template's; 0: any orientation
  bool flip = false;    // either way up

  bool any() const { return tilt_rad <= 0; }

  /// Cosine of the view's z and the template's, of template_from_view.
  template <class Scalar>
  Scalar uprightness(const Eigen::Matrix<Scalar, 3, 3>& rotation) const {
    return flip ? std::abs(rotation(2, 2)) : rotation(2, 2);
  }

  /// Of the largest tilt that is searched: no less than poses err by, and short of lying down, or up could
  /// not be told from down.
  double least_uprightness() const {
    constexpr double kReach = 2.6, kLeastTilt = 0.09, kMostTilt = 1.5;  // standard deviations, rad
    return any() ? -1 : std::cos(std::clamp(kReach * tilt_rad, kLeastTilt, kMostTilt));
  }

  template <class Scalar>
  bool allows(const Eigen::Matrix<Scalar, 3, 3>& rotation) const {
    return any() || static_cast<double>(uprightness(rotation)) >= least_uprightness();
  }

  /// The same where the template has a group: of one of the images of the pose.
  template <class Scalar>
  bool allows(const Eigen::Matrix<Scalar, 3, 3>& rotation, const std::vector<Eigen::Matrix3d>& group) const {
    return allows(rotation) || std::any_of(group.begin(), group.end(), [&](const Eigen::Matrix3d& g) {
             const Eigen::Matrix<Scalar, 3, 3> image = g.cast<Scalar>() * rotation;
             return allows(image);
           });
  }

  /// Of all orientations.
  double share() const { return any() ? 1 : (1 - least_uprightness()) / 2 * (flip ? 2 : 1); }
};

}  // namespace polar
