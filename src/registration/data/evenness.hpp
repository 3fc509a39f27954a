// How far a particle's localisations are from even: a filament, a bright emitter or a bead may hold most of
// them, and then centre, scale and every small sample would describe it instead of the structure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "polar/core/rng.hpp"

namespace polar {

/// Radius in which the density of localisations is counted, in particle radii.
constexpr double kEvennessReach = 0.08;

/// A weight in (0, 1] for each localisation (points 3 x n, `reach` in their unit): 1 up to the density of the
/// thinnest quarter and a part of its counting noise, falling as one over the density beyond.
std::vector<double> even_weights(const Eigen::Matrix3Xf& points, double reach);

/// A random order in which every prefix is a sample without replacement by these weights.
std::vector<std::uint32_t> sampling_order(const std::vector<double>& weight, KeyedRandom random);

}  // namespace polar
