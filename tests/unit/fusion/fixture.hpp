// A small template and views drawn from it, for the tests of the fusion layer.
#pragma once

#include <cmath>

#include "polar/core/covariance3.hpp"
#include "polar/core/pose.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/effective.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar::fixture {

inline Mixture random_mixture(int centres, std::uint64_t seed, bool planar = false) {
  KeyedRandom random(seed, 0, 1);
  Mixture m;
  m.centre.resize(3, centres);
  m.weight.resize(centres);
  for (int k = 0; k < centres; ++k) {
    Eigen::Vector3d c = random.direction() * std::cbrt(random.uniform());
    if (planar) c.z() = 0;
    m.centre.col(k) = c.cast<float>();
    m.weight[k] = static_cast<float>(0.5 + random.uniform());
  }
  m.weight /= m.weight.sum();
  m.outlier_fraction = 0.1;
  m.outlier_density = 0.1;
  sort_into_blocks(m);
  return m;
}

/// n localisations of a view at `template_from_view`, sigmas (lateral, lateral, axial), no outliers.
inline View draw_view(const Mixture& m, const Pose& template_from_view, int n, float lateral, float axial,
                      std::uint64_t seed, bool planar = false) {
  KeyedRandom random(seed, 0, 2);
  View view;
  view.points.resize(3, n);
  const Pose view_from_template = template_from_view.inverse();
  for (int j = 0; j < n; ++j) {
    double left = random.uniform();
    Eigen::Index k = 0;
    while (k + 1 < m.size() && (left -= static_cast<double>(m.weight[k])) > 0) ++k;
    const double x = random.normal(), y = random.normal(), z = random.normal();
    Eigen::Vector3d p = view_from_template * Eigen::Vector3d(m.centre.col(k).cast<double>());
    p += Eigen::Vector3d(double(lateral) * x, double(lateral) * y, planar ? 0 : double(axial) * z);
    view.points.col(j) = p.cast<float>();
    view.covariance.push_back(axial_covariance(lateral * lateral, axial * axial));
  }
  return view;
}

inline Pose random_pose(std::uint64_t seed, bool planar = false) {
  KeyedRandom random(seed, 0, 3);
  Pose pose;
  pose.rotation = planar ? so3_exp({0, 0, 6 * random.uniform()}) : random.rotation();
  pose.translation = 0.1 * random.direction();
  if (planar) pose.translation.z() = 0;
  return pose;
}

}  // namespace polar::fixture
