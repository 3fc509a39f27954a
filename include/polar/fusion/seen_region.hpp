// Where a view certainly looked. Whatever cuts a particle off (a plane of focus, the edge of a field, a
// section) leaves a convex part of it, so inside the convex hull of a view's localisations nothing was cut:
// what another view shows there and this one does not contradicts their alignment.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

class SeenRegion {
 public:
  SeenRegion() = default;
  /// Of points 3 x n. Robust: along each of a set of directions the farthest 1.5 % of the points do not
  /// count.
  explicit SeenRegion(const Eigen::Matrix3Xf& points);

  bool contains(const Eigen::Vector3f& x) const;

 private:
  std::vector<float> farthest_;  // along each direction
};

}  // namespace polar
