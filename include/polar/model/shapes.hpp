// Sets of shapes for training and scores.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/rng.hpp"

namespace polar {

/// Shapes of one or more files, kept as the 16-bit integers they are stored as (a fourth of the memory).
struct ShapeSet {
  struct File {
    std::string path;
    std::uint64_t shapes = 0, points_per_shape = 0;
    double scale = 1;
    std::vector<std::int16_t> points;  // (shape, point, 3)
  };
  std::vector<File> files;

  std::uint64_t size() const;
  /// `points` of shape `index` (0 to size() - 1) chosen by `random` without repetition, in shape coordinates.
  Eigen::Matrix3Xf sample(std::uint64_t index, int points, KeyedRandom& random) const;
};

/// Reads files with the data set `points`, int16 (shape, point, 3), and its attribute `scale`. Throws
/// smlm::Error (input) for other files and for shapes of fewer than `min_points` points.
ShapeSet read_shapes(const std::vector<std::string>& paths, int min_points);

}  // namespace polar
