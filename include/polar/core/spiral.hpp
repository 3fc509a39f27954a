// Directions spread evenly over the sphere or half of it: a spiral from the pole whose neighbours are a
// golden angle apart.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "polar/core/constants.hpp"

namespace polar {

/// Of z that a spiral passes: from the pole to the equator (an axis has no sign), or to the other pole.
enum class Spiral { hemisphere = 1, sphere = 2 };

/// Direction `i` of `count`, a unit vector.
template <typename Real>
Eigen::Matrix<Real, 3, 1> spiral_direction(int i, int count, Spiral over) {
  const auto k = static_cast<Real>(i);
  const Real z = 1 - static_cast<Real>(over) * (k + Real(0.5)) / static_cast<Real>(count);
  const Real r = std::sqrt(1 - z * z), phi = static_cast<Real>(kGoldenAngle) * k;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// All of them.
template <typename Real>
std::vector<Eigen::Matrix<Real, 3, 1>> spiral_directions(int count, Spiral over) {
  std::vector<Eigen::Matrix<Real, 3, 1>> out;
  out.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) out.push_back(spiral_direction<Real>(i, count, over));
  return out;
}

}  // namespace polar
