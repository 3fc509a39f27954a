#pragma once

#include <Eigen/Core>
#include <vector>

#include "mixture_kernel.hpp"

namespace polar {

/// A Gaussian that is drawn at many places of a volume with one covariance.
class VoxelGaussian {
 public:
  /// `covariance` in units whose voxel is `voxel`; in the plane the third axis counts for nothing. Drawn to
  /// `reach` standard deviations.
  VoxelGaussian(const Eigen::Matrix3f& covariance, float voxel, float reach, bool planar);

  /// As the kernels take it, about `centre` in voxels; valid as long as this lives.
  kernel::VoxelGaussian at(const Eigen::Vector3f& centre, float amplitude) const;

 private:
  kernel::VoxelGaussian gaussian_{};
  std::vector<float> profile_;
  bool planar_;
};

}  // namespace polar
