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
  NoiseModel noise;           // a and b; width as given, inside b once fitted
  double log_likelihood = 0;  // mean per localisation of `held_out`
};

/// Maximises over a and b (axial ones only where views have an axis), starting from `start`, whose width goes
/// into b. `visibility`: factors of every view's centres
/// (FusionData::set_visibility), or none. A weak prior holds a at 1 where sigma hardly varies and a and b
/// cannot be told apart.
CalibrationReport calibrate(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                            const Subsets& held_out, const Mixture& mixture,
                            const std::vector<Pose>& template_from_view, const NoiseModel& start,
                            const std::vector<std::vector<float>>& visibility = {});

/// True where lateral and axial uncertainties differ enough to be calibrated apart.
bool has_axis(const Views& views, const std::vector<Eigen::Vector3f>& axes);

}  // namespace polar
