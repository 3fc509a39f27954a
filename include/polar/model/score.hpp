// How well an autoencoder restores shapes that it never saw.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "polar/model/autoencoder.hpp"
#include "polar/model/shapes.hpp"

namespace polar {

/// What is done to a clean cloud of 1024 points (centred, largest radius 1, turned at random) before
/// encoding.
struct ScoreConditions {
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  // Gaussian noise per axis of the view
  int points = 1024;                                // of the 1024, at most
};

/// The four conditions that weights are compared under: clean; isotropic noise .05; anisotropic noise
/// (.02, .02, .1); 200 points.
struct NamedConditions {
  std::string name;
  ScoreConditions conditions;
};
std::vector<NamedConditions> standard_conditions();

/// Mean over the set's shapes of the Chamfer distance (sum of both mean distances) between D(E(spoilt)) and
/// the clean cloud. Deterministic in the seed.
double mean_chamfer(const Autoencoder& model, const ShapeSet& shapes, const ScoreConditions& conditions,
                    std::uint64_t seed);

}  // namespace polar
