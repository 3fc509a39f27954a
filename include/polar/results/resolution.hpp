// What two halves of the particles, registered independently, have in common: the resolution of a result and
// its control on pure noise.
#pragma once

#include <cstddef>

#include "polar/core/pose.hpp"
#include "polar/results/fourier_shell.hpp"

namespace polar {

/// Two half maps, aligned to one another only after both were registered.
struct HalfMaps {
  std::size_t first_particles = 0, second_particles = 0;  // accepted in each half
  Pose first_from_second_nm;
  double voxel_nm = 0;
  Volume first_density, second_density;  // in one box, the second one aligned
  FourierShells shells;
  ShellResolution resolution;
};

/// `noise`: the same for particles of structureless noise (see noise_particles). What it resolves is what
/// registration alone makes of noise, "Einstein from noise" (R. Henderson, PNAS 110, 18037-18041, 2013).
struct ResolutionReport {
  HalfMaps data, noise;

  /// True when the data resolve something, and finer than noise does.
  bool supported() const;
};

}  // namespace polar
