#include "self_similarity.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {

constexpr int kPoints = 600;        // that stand for the mass: similarities err by 1/sqrt of them
constexpr int kTurnsAtRandom = 60;  // that say what no similarity is
constexpr float kFloor = 0.02f;     // of the highest density: what lies outside is no infinite loss
constexpr std::uint32_t kTurnStage = 41;

Pose about(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) {
  return {turn, centre - turn * centre};
}

DensityGrid blurred(DensityGrid density, double blur) {
  density.blur(blur);
  density.normalise(0);
  return density;
}

float highest(const DensityGrid& d) { return *std::max_element(d.value().begin(), d.value().end()); }

// Evenly through the mass, in the order of the voxels.
LookupPoints points_of(const DensityGrid& d) {
  double mass = 0;
  for (const float v : d.value()) mass += static_cast<double>(v);
  LookupPoints out;
  const double step = mass / kPoints;
  double sum = 0, next = step / 2;
  for (std::size_t v = 0; v < d.value().size(); ++v)
    for (sum += static_cast<double>(d.value()[v]); sum > next; next += step) out.add(d.position(v));
  out.pad();
  return out;
}

}  // namespace

SelfSimilarity::SelfSimilarity(DensityGrid density, double blur)
    : density_(blurred(std::move(density), blur)),
      floor_(kFloor * highest(density_)),
      volume_(density_, 0.5, static_cast<double>(2 * floor_)),
      points_(points_of(density_)),
      centroid_(density_.centroid()) {
  if (planar()) centroid_.z() = 0;
  KeyedRandom random(0, 0, kTurnStage);
  std::vector<Pose> any;
  double sum = 0;
  coarse_own_ = 1;
  for (int i = 0; i < kTurnsAtRandom; ++i) {
    const Eigen::Matrix3d turn = planar() ? so3_exp({0, 0, kTwoPi * random.uniform()}) : random.rotation();
    sum += coarse(turn, centroid_);
    any.push_back(about(turn, centroid_));
  }
  coarse_own_ = coarse(Eigen::Matrix3d::Identity(), centroid_);
  coarse_any_ = sum / kTurnsAtRandom;
  exact_own_ = log_density({Pose{}});
  exact_any_ = log_density(any);
}

double SelfSimilarity::coarse(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) const {
  const Pose motion = about(turn, centre);
  const double score =
      static_cast<double>(volume_.score(points_, turn.cast<float>(), motion.translation.cast<float>()) /
                          static_cast<float>(points_.count));
  return (score - coarse_any_) / (coarse_own_ - coarse_any_);
}

double SelfSimilarity::exact(const std::vector<Pose>& motion) const {
  return (log_density(motion) - exact_any_) / (exact_own_ - exact_any_);
}

double SelfSimilarity::log_density(const std::vector<Pose>& motion) const {
  double sum = 0;
  for (const Pose& m : motion)
    for (std::size_t k = 0; k < static_cast<std::size_t>(points_.count); ++k) {
      const Eigen::Vector3d x(static_cast<double>(points_.x[k]), static_cast<double>(points_.y[k]),
                              static_cast<double>(points_.z[k]));
      sum += std::log(static_cast<double>(density_.at((m * x).cast<float>()) + floor_));
    }
  return sum / static_cast<double>(points_.count) / static_cast<double>(motion.size());
}

}  // namespace polar
