// The masks M^v and M^o (paper III.D.c and d).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

/// Distance of every point of `from` to its nearest point of `to` (the paper's D_{P -> Q}).
Eigen::VectorXf nearest_distances(const Eigen::Matrix3Xf& from, const Eigen::Matrix3Xf& to);

/// Indices, ascending, of the `share` of points that lie nearest to the other cloud; at least one.
std::vector<int> nearest_share(const Eigen::VectorXf& distance, double share);

Eigen::Matrix3Xf columns(const Eigen::Matrix3Xf& cloud, const std::vector<int>& which);

}  // namespace polar
