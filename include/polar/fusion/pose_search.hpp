// FLAMES (paper III.E.a) over the likelihood of a view: rotations x a few translations, scored by look-ups in
// direction-blurred volumes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/flames/search_grid.hpp"
#include "polar/fusion/direction_volumes.hpp"

namespace polar {

struct SearchOptions {
  std::vector<Eigen::Vector3f> translation = {Eigen::Vector3f::Zero()};  // tried with every rotation
  int promising = 400;  // best rotations whose translation is then improved
  float step = 0;       // of that improvement, halved once; 0: none
};

/// For every rotation of the grid, turned by `turn` first: the best score and its translation.
struct GridScores {
  std::vector<float> log_likelihood;
  std::vector<Eigen::Vector3f> translation;
};
GridScores score_grid(const DirectionVolumes& volumes, const SearchView& view, const SearchGrid& grid,
                      const Eigen::Matrix3f& turn, const SearchOptions& options);

/// Local optima over the grid, best first: poses template_from_view.
std::vector<Pose> basins(const GridScores& scores, const SearchGrid& grid, const Eigen::Matrix3f& turn,
                         int most);

/// A pose template_from_view and its log likelihood by look-ups.
struct LookedUpPose {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
  float score = 0;
};
/// Uphill from `start` by look-ups alone, over turns and shifts that are halved twice.
LookedUpPose climbed(const DirectionVolumes& volumes, const SearchView& view, const Pose& start, float turn,
                     float shift, bool planar);

/// 0 and +-shift along the axes (7), planar without z (5).
std::vector<Eigen::Vector3f> axis_shifts(float shift, bool planar);

}  // namespace polar
