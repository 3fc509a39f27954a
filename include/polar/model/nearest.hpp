// Nearest neighbours between two clouds by comparing all pairs, which beats a tree up to some thousand
// points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

/// For every point of `from` the index of the nearest point of `to`; `to` needs at least one point.
std::vector<int> nearest(const Eigen::Ref<const Eigen::Matrix3Xf>& from,
                         const Eigen::Ref<const Eigen::Matrix3Xf>& to);

}  // namespace polar
