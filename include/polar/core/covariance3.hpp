// A symmetric 3 x 3 covariance as tables and views hold it, six numbers in the order xx xy xz yy yz zz: made
// and read here, so that nobody counts places.
#pragma once

#include <Eigen/Core>

#include "polar/core/view.hpp"

namespace polar {

inline Eigen::Matrix3d matrix(const Symmetric3& c) {
  Eigen::Matrix3d m;
  m << double(c[0]), double(c[1]), double(c[2]),  //
      double(c[1]), double(c[3]), double(c[4]),   //
      double(c[2]), double(c[4]), double(c[5]);
  return m;
}

inline Eigen::Matrix3f matrix3f(const Symmetric3& c) { return matrix(c).cast<float>(); }

/// Rounded to single precision; only the upper half is read.
inline Symmetric3 symmetric3(const Eigen::Matrix3d& m) {
  const Eigen::Matrix3f s = m.cast<float>();
  return {s(0, 0), s(0, 1), s(0, 2), s(1, 1), s(1, 2), s(2, 2)};
}

/// The same variance along x and y, another one along z.
constexpr Symmetric3 axial_covariance(float lateral, float axial) {
  return {lateral, 0, 0, lateral, 0, axial};
}

constexpr Symmetric3 isotropic_covariance(float variance) { return axial_covariance(variance, variance); }

}  // namespace polar
