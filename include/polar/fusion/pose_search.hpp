// FLAMES (paper III.E.a) over the likelihood of a view: rotations x a few translations, scored by look-ups in
// direction-blurred volumes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/flames/search_grid.hpp"
#include "polar/fusion/cuts.hpp"
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
/// `closer`: more localisations of the same view; the promising rotations are then scored by those, and the
/// others score minus infinity.
GridScores score_grid(const DirectionVolumes& volumes, const SearchView& view, const SearchGrid& grid,
                      const Eigen::Matrix3f& turn, const SearchOptions& options,
                      const SearchView* closer = nullptr, const CutView& cut = {});

struct Basin {
  Pose template_from_view;
  float log_likelihood = 0;
};

/// Local optima over the grid, best first.
std::vector<Basin> basins(const GridScores& scores, const SearchGrid& grid, const Eigen::Matrix3f& turn,
                          int most);

/// 0 and +-shift along the axes (7), planar without z (5).
std::vector<Eigen::Vector3f> axis_shifts(float shift, bool planar);

/// A cubic lattice within a ball of radius `reach`; planar: a square one within a disc.
std::vector<Eigen::Vector3f> lattice_shifts(double reach, double spacing, bool planar);

/// One step along the axes, or such a lattice where `reach` is longer than a step.
std::vector<Eigen::Vector3f> shifts_within(float reach, float step, bool planar);

}  // namespace polar
