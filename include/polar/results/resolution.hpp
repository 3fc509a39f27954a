// What two halves of the particles, registered independently, have in common: the resolution of a result and
// its control on pure noise.
#pragma once

#include <cstddef>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/results/fourier_shell.hpp"

namespace polar {

/// Sums of a cubic density through its depth, on the planes xy, xz and yz (planar: the density itself, xy).
struct Projections {
  std::size_t edge = 0;      // pixels
  std::vector<float> value;  // planes x edge x edge, rows from the bottom; localisations per nm^2

  std::size_t planes() const { return edge == 0 ? 0 : value.size() / (edge * edge); }
};
Projections projections_of(const Volume& density);

/// Two half maps, aligned to one another only after both were registered.
struct HalfMaps {
  std::size_t first_particles = 0, second_particles = 0;  // accepted in each half
  Pose first_from_second_nm;
  double voxel_nm = 0;
  Volume first_density, second_density;  // in one box, in the frame of the whole where there is one
  Projections first_projections, second_projections;  // of those: what a page shows of them
  FourierShells shells;
  ShellResolution resolution;
  /// No pose of a half was accepted: shells and densities are those of the poses that were refused, to look
  /// at, and nothing counts as resolved.
  bool refused = false;
};

/// `noise`: the same for particles of structureless noise (see noise_particles). What it resolves is what
/// registration alone makes of noise, "Einstein from noise" (R. Henderson, PNAS 110, 18037-18041, 2013).
struct ResolutionReport {
  HalfMaps data, noise;

  /// True when the data resolve something, and finer than noise does.
  bool supported() const;
};

}  // namespace polar
