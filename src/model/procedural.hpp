// Random structures to train on: unions, mirrored and n-fold particles of simple solids and tubes, and the
// discrete ones that microscopy shows - rings of sites, polyhedra of sites, flat grids.
#pragma once

#include <Eigen/Core>

#include "polar/core/rng.hpp"
#include "polar/model/train_options.hpp"

namespace polar {

/// `points` samples of one random structure, 3 x points, centred, largest radius 1. Everything about it is
/// drawn from `random`; `data` says how often it is made of sites.
Eigen::Matrix3Xf procedural_cloud(int points, KeyedRandom& random, const TrainData& data = {});

/// Moves a cloud's mean to 0 and scales its largest radius to 1.
void centre_and_normalise(Eigen::Matrix3Xf& cloud);

}  // namespace polar
