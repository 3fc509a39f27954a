// The particle sets of the averaging programs, once they are out of their .mat file.
#pragma once

#include <string>
#include <vector>

#include "../column_arrays.hpp"

namespace smlm::readers {

/// A matrix of doubles, column-major as in MATLAB.
struct Matrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
  double operator()(std::size_t row, std::size_t column) const { return values[column * rows + row]; }
};

/// One cell of `particles`: either points and sigma, or coords (x, y, z, ..., column 5 sigma_xy, column 10
/// sigma_z), or a bare matrix x, y, sigma. Absent matrices are empty.
struct MatParticle {
  Matrix points, sigma, coords;
};

/// One row a localisation, the particle its cell's 1-based number. These files say neither unit nor whether
/// sigma is a standard deviation or a variance: options.unit and options.sigma_kind do, or a warning.
LocalisationTable build_particle_table(const std::string& path, const std::vector<MatParticle>& particles,
                                       const ReadOptions& options);

}  // namespace smlm::readers
