// One training example: a clean cloud, and what a microscope might have left of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "polar/core/rng.hpp"
#include "polar/model/shapes.hpp"
#include "polar/model/train_options.hpp"

namespace polar {

struct TrainingCloud {
  Eigen::Matrix3Xf input;   // degraded, 3 x (min_points ... max_points)
  Eigen::Matrix3Xf target;  // clean, 3 x 1024, in the frame of the input
};

/// Example number `item` of the run with this seed: a pure function of its arguments.
TrainingCloud training_cloud(std::uint64_t seed, std::uint64_t item, const TrainData& data,
                             const ShapeSet& shapes, const Degradation& degradation);

/// The degraded copy of `clean` (largest radius 1) alone; `target` receives the frame's motion and scale.
Eigen::Matrix3Xf degrade(const Degradation& degradation, KeyedRandom& random, Eigen::Matrix3Xf& target);

}  // namespace polar
