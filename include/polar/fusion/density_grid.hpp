// The density of posed localisations on voxels: a template that needs no model of the noise, because the
// noise is in it, and whose look-up costs the same whatever the structure.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace polar {

/// A cube about the origin of the template's frame (planar: a square), x the fastest axis. Lengths in
/// particle radii.
struct VoxelFrame {
  VoxelFrame(double reach, double voxel, bool planar);

  int dim[3];
  float voxel;
  Eigen::Vector3f origin;  // centre of voxel (0, 0, 0)

  bool planar() const { return dim[2] == 1; }
  std::size_t size() const {
    return static_cast<std::size_t>(dim[0]) * static_cast<std::size_t>(dim[1]) *
           static_cast<std::size_t>(dim[2]);
  }
  float volume() const { return planar() ? voxel * voxel : voxel * voxel * voxel; }
};

/// Points as the look-up kernels take them: arrays padded to a multiple of 16 with repeats of the last.
struct LookupPoints {
  std::vector<float> x, y, z;
  int count = 0;

  void add(const Eigen::Vector3f& p) { x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()), ++count; }
  void pad();
};

/// Whole numbers a voxel, so that neither order nor threads change the sum.
class VoxelCounts {
 public:
  explicit VoxelCounts(const VoxelFrame& frame) : frame_(frame), count_(frame.size(), 0) {}
  /// Adds `weight` at the voxel of every point, template_from_view applied; points outside are left out.
  void add(const LookupPoints& points, const Eigen::Matrix3f& rotation, const Eigen::Vector3f& translation,
           std::uint32_t weight);
  VoxelCounts& operator+=(const VoxelCounts& other);
  const VoxelFrame& frame() const { return frame_; }
  const std::vector<std::uint32_t>& count() const { return count_; }

 private:
  VoxelFrame frame_;
  std::vector<std::uint32_t> count_;
};

class DensityGrid {
 public:
  explicit DensityGrid(const VoxelFrame& frame) : frame_(frame), value_(frame.size(), 0.0f) {}
  explicit DensityGrid(const VoxelCounts& counts);

  const VoxelFrame& frame() const { return frame_; }
  const std::vector<float>& value() const { return value_; }

  /// Gaussian of this standard deviation on every axis.
  void blur(double sigma);
  /// No voxel above the density that leaves `share` of the mass above it: what one bright spot may weigh.
  void cap(double share);
  /// To mass 1, nowhere below `least`.
  void normalise(float least = 1e-6f);

  /// Trilinear; 0 outside.
  float at(const Eigen::Vector3f& x) const;
  Eigen::Vector3d centroid() const;
  Eigen::Vector3f position(std::size_t voxel) const;

 private:
  VoxelFrame frame_;
  std::vector<float> value_;
};

/// ln((1 - e) density + e u) as 16-bit numbers: a pose costs one nearest-voxel look-up a localisation, added
/// as integers, the same on every machine.
class LogVolume {
 public:
  LogVolume(const DensityGrid& density, double outlier_fraction, double outlier_density);

  /// sum_j ln p(R x_j + t) for each t.
  void scores(const LookupPoints& points, const Eigen::Matrix3f& rotation, const Eigen::Vector3f* translation,
              std::size_t shifts, float* score) const;
  float score(const LookupPoints& points, const Eigen::Matrix3f& rotation,
              const Eigen::Vector3f& translation) const;

 private:
  VoxelFrame frame_;
  float zero_ = 0, scale_ = 1;  // ln p = value / scale + zero
  std::vector<std::int16_t> value_;
};

}  // namespace polar
