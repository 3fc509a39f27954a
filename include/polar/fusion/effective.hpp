// From a stated uncertainty to the covariance the likelihood uses: calibrated, widened by the label size.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "polar/core/view.hpp"

namespace polar {

/// sigma_eff^2 = a^2 sigma^2 + b^2 along and across the axis of a view (method: docs/method.md), then the
/// template's own width on every axis.
struct NoiseModel {
  double lateral_factor = 1, axial_factor = 1;  // a
  double lateral_extra = 0, axial_extra = 0;    // b, length
  double width = 0;                             // length
  bool planar = false;
};

/// Direction along which a view's uncertainties differ from the other two (unit vector, frame of the view);
/// the optical axis for tables as imaged. z where they hardly differ, and in planar data.
Eigen::Vector3f uncertainty_axis(const View& view, bool planar);

/// Standard deviations of a stated covariance across (root mean square of two) and along a unit axis.
struct AxialSigma {
  float lateral = 0, axial = 0;
};
AxialSigma axial_sigma(const Symmetric3& covariance, const Eigen::Vector3f& axis);

/// The effective covariance of one localisation.
Symmetric3 effective_covariance(const Symmetric3& stated, const Eigen::Vector3f& axis,
                                const NoiseModel& noise);

}  // namespace polar
