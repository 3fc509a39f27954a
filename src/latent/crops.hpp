// A view that was cropped by a plane does not lie where its template lies: what is left has another centre.
// FLAMES therefore tries the template under a few such crops, each about its own centre, and the views about
// theirs: a code for every rotation and crop serves all views, and brings the shift with it.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polar {

struct Crop {
  Eigen::Matrix3Xf points;  // about `centre`
  std::vector<int> kept;    // which of the given points they are, ascending
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
};

/// `share` of the points on one side of a plane, for planes in `directions` directions spread over the sphere
/// (planar: the circle); of each at most the first `most` points.
std::vector<Crop> plane_crops(const Eigen::Matrix3Xf& points, double share, int directions, int most,
                              bool planar);

}  // namespace polar
