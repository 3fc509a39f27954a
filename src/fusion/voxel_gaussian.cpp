#include "voxel_gaussian.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace polar {

namespace {
// A profile is shifted by at most 1 / 160 of its standard deviation: 2 % of a value at 3.5 of them, and of a
// look-up at the nearest voxel far less than its own error (direction_volumes.cpp).
constexpr float kPhasesPerSigma = 80;
constexpr int kMostPhases = 256;
}  // namespace

VoxelGaussian::VoxelGaussian(const Eigen::Matrix3f& covariance, float voxel, float reach, bool planar)
    : planar_(planar) {
  const Eigen::Matrix3f p = covariance.inverse() * (voxel * voxel);
  kernel::VoxelGaussian& g = gaussian_;
  g.pxx = p(0, 0), g.pxy = p(0, 1), g.pxz = p(0, 2), g.pyy = p(1, 1), g.pyz = p(1, 2), g.pzz = p(2, 2);
  g.reach = reach;
  for (int a = 0; a < (planar ? 2 : 3); ++a) g.extent[a] = reach * std::sqrt(covariance(a, a)) / voxel;
  const float sigma = 1 / std::sqrt(g.pxx);
  g.phases = std::clamp(static_cast<int>(std::ceil(kPhasesPerSigma / sigma)), 1, kMostPhases);
  g.lead = static_cast<int>(std::ceil(reach * sigma)) + 1;
  g.stride = 2 * g.lead + 1 + kernel::kBlock;
  profile_.resize(static_cast<std::size_t>((g.phases + 1) * g.stride));
  for (int f = 0; f <= g.phases; ++f) {
    const float middle = static_cast<float>(g.lead) + static_cast<float>(f) / static_cast<float>(g.phases);
    Eigen::Map<Eigen::ArrayXf> row(profile_.data() + f * g.stride, g.stride);
    row = (Eigen::ArrayXf::LinSpaced(g.stride, 0, static_cast<float>(g.stride - 1)) - middle) / sigma;
    row = (-0.5f * row.square()).exp();
  }
  g.profile = profile_.data();
}

kernel::VoxelGaussian VoxelGaussian::at(const Eigen::Vector3f& centre, float amplitude) const {
  kernel::VoxelGaussian g = gaussian_;
  g.x = centre.x(), g.y = centre.y(), g.z = planar_ ? 0 : centre.z();
  g.amplitude = amplitude;
  return g;
}

}  // namespace polar
