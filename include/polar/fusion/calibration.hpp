// Are the stated uncertainties the real ones? sigma_eff^2 = a^2 sigma^2 + b^2, along and across the axis of
// each view apart, fitted by the likelihood of localisations that the template was not fitted to.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

struct CalibrationReport {
  NoiseModel noise;  // a and b; width as given, inside b once fitted
};

/// Maximises over a and b (axial ones only where lateral and axial uncertainties differ enough to be told
/// apart), starting from `start`, whose width goes into b. A weak prior holds a at 1 where sigma hardly
/// varies and a and b cannot be told apart.
CalibrationReport calibrate(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                            const Subsets& held_out, const Mixture& mixture,
                            const std::vector<Pose>& template_from_view, const NoiseModel& start);

}  // namespace polar
