// What the engine registers: one particle's localisations, centred and scaled to order 1, each with its
// own covariance.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace polar {

/// Symmetric 3 x 3, order xx xy xz yy yz zz.
using Symmetric3 = std::array<float, 6>;

struct View {
  Eigen::Matrix3Xf points;             // 3 x n, dimensionless, about the view's robust centre
  std::vector<Symmetric3> covariance;  // n, same unit squared, frame of the view
};

/// How views were made from particles: x_view = (x_nm - centre_nm) / scale_nm, one scale for all.
struct Normalisation {
  std::vector<Eigen::Vector3d> centre_nm;  // one a view
  double scale_nm = 1;
};

struct Views {
  std::vector<View> view;
  Normalisation normalisation;
  bool planar = false;  // z is 0 everywhere: motions are in the plane
};

}  // namespace polar
