// The parts that procedural structures are made of: surfaces, tubes along curves, and clusters around sites.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "polar/core/rng.hpp"

namespace polar {

struct Part {
  double weight = 1;                                    // share of the points, e.g. the area
  std::function<Eigen::Vector3d(KeyedRandom&)> sample;  // one point
};

/// Box, cylinder, cone, torus (or an arc of one), ellipsoid, disc or helix of random size about the origin.
Part random_primitive(KeyedRandom& random);

/// Tube of constant radius along a random smooth curve.
Part random_tube(KeyedRandom& random);

/// Gaussian clusters of width `label_size`, one around each site.
Part site_clusters(std::vector<Eigen::Vector3d> sites, double label_size);

/// `part` turned and moved.
Part moved(Part part, const Eigen::Matrix3d& linear, const Eigen::Vector3d& shift);

}  // namespace polar
