// The posterior of one view's pose under a density, by look-ups: its value, and the way up to a mode.
#pragma once

#include "soft_poses.hpp"

namespace polar {

/// ln of likelihood and prior of one view's poses, scaled so that beta times it is the tempered posterior.
class Scorer {
 public:
  /// `shift`: standard deviation of the prior of shifts from `centre`.
  Scorer(const LogVolume& volume, const LookupPoints& points, const PosePrior& prior,
         const Eigen::Vector3f& centre, double shift, double prior_weight);

  /// Of one rotation with each of some translations.
  void operator()(const Eigen::Matrix3f& rotation, const Eigen::Vector3f* translation, std::size_t shifts,
                  float* score) const;
  float operator()(const SoftPose& pose) const;

 private:
  float tilt_of(const Eigen::Matrix3f& rotation) const;
  const LogVolume& volume_;
  const LookupPoints& points_;
  const PosePrior& prior_;
  Eigen::Vector3f centre_;
  float by_shift_, by_tilt_;
};

/// Uphill over the neighbours along the axes of rotation and shift, whose steps halve `levels` - 1 times;
/// returns the score. Turns are about `centre`.
float climb(const Scorer& scorer, const Eigen::Vector3f& centre, float turn, float shift, int levels,
            bool planar, SoftPose& pose);

/// `turn` after the pose, about a point of the template.
SoftPose turned_about(const SoftPose& pose, const Eigen::Vector3f& centre, const Eigen::Matrix3f& turn);

/// Of the quaternion (1, w / 2), normalised: a rotation about w by nearly its length, cheaper than the
/// exponential.
Eigen::Matrix3f small_turn(const Eigen::Vector3f& w);

}  // namespace polar
