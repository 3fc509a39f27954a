// A mixture laid out for the kernels, and its image in the frame of a view.
#pragma once

#include <vector>

#include "mixture_kernel.hpp"
#include "polar/core/pose.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// Arrays padded to whole blocks. Expects centres sorted into blocks.
class BlockedMixture {
 public:
  explicit BlockedMixture(const Mixture& mixture);

  int blocks() const { return blocks_; }
  int padded_size() const { return blocks_ * kernel::kBlock; }
  float background() const { return background_; }
  const float* weight() const { return weight_.data(); }

 private:
  friend class ViewFrame;
  int blocks_;
  float background_;                       // outlier_fraction x outlier_density
  std::vector<float> x_, y_, z_, weight_;  // weight times (1 - outlier_fraction)
  std::vector<float> block_x_, block_y_, block_z_, block_radius_;
};

/// The centres moved by view_from_template; buffers are reused from pose to pose.
class ViewFrame {
 public:
  explicit ViewFrame(const BlockedMixture& mixture);

  /// `weight`: as many as padded_size(), or null for the mixture's own.
  const kernel::Centres& at(const Pose& view_from_template, const float* weight = nullptr);

 private:
  const BlockedMixture& mixture_;
  std::vector<float> x_, y_, z_, block_x_, block_y_, block_z_;
  kernel::Centres centres_;
};

}  // namespace polar
