// The template as points.
#pragma once

#include "polar/model/autoencoder.hpp"

namespace polar {

/// D(z); for planar data without its z.
inline Eigen::Matrix3Xf template_points(const Autoencoder& model, const Eigen::VectorXf& z, bool planar) {
  Eigen::Matrix3Xf points = model.decode(z);
  if (planar) points.row(2).setZero();
  return points;
}

}  // namespace polar
