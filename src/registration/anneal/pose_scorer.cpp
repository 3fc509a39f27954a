#include "pose_scorer.hpp"

#include <algorithm>
#include <cmath>

namespace polar {

namespace {
constexpr int kMostClimbs = 3;       // steps of one size
constexpr float kClimbGain = 1e-3f;  // less is rounding
}  // namespace

Scorer::Scorer(const LogVolume& volume, const LookupPoints& points, const PosePrior& prior,
               const Eigen::Vector3f& centre, double shift, double prior_weight)
    : volume_(volume),
      points_(points),
      prior_(prior),
      centre_(centre),
      by_shift_(static_cast<float>(-0.5 * prior_weight / (shift * shift))),
      by_tilt_(prior.tilt_rad > 0
                   ? static_cast<float>(-0.5 * prior_weight / (prior.tilt_rad * prior.tilt_rad))
                   : 0.0f) {}

void Scorer::operator()(const Eigen::Matrix3f& rotation, const Eigen::Vector3f* translation,
                        std::size_t shifts, float* score) const {
  volume_.scores(points_, rotation, translation, shifts, score);
  const float tilt = by_tilt_ == 0 ? 0 : tilt_of(rotation);
  for (std::size_t s = 0; s < shifts; ++s)
    score[s] += by_shift_ * (translation[s] - centre_).squaredNorm() + by_tilt_ * tilt * tilt;
}

float Scorer::operator()(const SoftPose& pose) const {
  float out = 0;
  (*this)(pose.rotation, &pose.translation, 1, &out);
  return out;
}

float Scorer::tilt_of(const Eigen::Matrix3f& rotation) const {
  return std::acos(std::clamp(prior_.uprightness(rotation), -1.0f, 1.0f));
}

float climb(const Scorer& scorer, const Eigen::Vector3f& centre, float turn, float shift, int levels,
            bool planar, SoftPose& pose) {
  float score = scorer(pose);
  for (int level = 0; level < levels; ++level, turn *= 0.5f, shift *= 0.5f) {
    Eigen::Matrix3f turns[6];
    int ways = 0;
    for (int a = planar ? 2 : 0; a < 3; ++a)
      for (const float sign : {-1.0f, 1.0f})
        turns[ways++] = small_turn(sign * turn * Eigen::Vector3f::Unit(a));
    for (int step = 0; step < kMostClimbs; ++step) {
      SoftPose best = pose;
      float most = score;
      Eigen::Vector3f there[6];
      float at[6];
      int n = 0;
      for (int a = 0; a < (planar ? 2 : 3); ++a)
        for (const float sign : {-1.0f, 1.0f})
          there[n++] = pose.translation + sign * shift * Eigen::Vector3f::Unit(a);
      scorer(pose.rotation, there, static_cast<std::size_t>(n), at);
      for (int k = 0; k < n; ++k)
        if (at[k] > most) most = at[k], best = {pose.rotation, there[k]};
      for (int w = 0; w < ways; ++w) {
        const SoftPose turned = turned_about(pose, centre, turns[w]);
        const float s = scorer(turned);
        if (s > most) most = s, best = turned;
      }
      if (most <= score + kClimbGain) break;
      pose = best, score = most;
    }
  }
  return score;
}

SoftPose turned_about(const SoftPose& pose, const Eigen::Vector3f& centre, const Eigen::Matrix3f& turn) {
  return {turn * pose.rotation, centre + turn * (pose.translation - centre)};
}

Eigen::Matrix3f small_turn(const Eigen::Vector3f& w) {
  return Eigen::Quaternionf(1, 0.5f * w.x(), 0.5f * w.y(), 0.5f * w.z()).normalized().toRotationMatrix();
}

}  // namespace polar
