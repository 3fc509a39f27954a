// How far points reach along directions, but for a few of them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace polar {

class Extent {
 public:
  /// Of points 3 x n, n > 0; they outlive the object.
  explicit Extent(const Eigen::Matrix3Xf& points)
      : points_(points), along_(static_cast<std::size_t>(points.cols())) {}

  void project(const Eigen::Vector3f& direction) {
    Eigen::Map<Eigen::RowVectorXf>(along_.data(), points_.cols()) = direction.transpose() * points_;
  }
  /// Below which this share of the projected points lies.
  float quantile(double share) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(along_.size() - 1));
    std::nth_element(along_.begin(), along_.begin() + at, along_.end());
    return along_[static_cast<std::size_t>(at)];
  }

 private:
  const Eigen::Matrix3Xf& points_;
  std::vector<float> along_;
};

}  // namespace polar
