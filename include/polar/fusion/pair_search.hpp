// Two views registered with each other, each perhaps showing only a part of the structure. One view's
// localisations are the template; the other is searched for over rotations and shifts as far as a part may
// lie from the whole. What one view shows outside the region that the other has seen says nothing; inside it,
// what only one of them shows counts against the alignment (seen_region.hpp).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/flames/search_grid.hpp"
#include "polar/fusion/fusion_data.hpp"

namespace polar {

struct PairSearchOptions {
  int rotations = 1152;         // of the grid; planar: a turn every two degrees
  double reach = 1.2;           // of the shifts, particle radii
  double shift = 0.25;          // between them
  int basins = 6;               // refined
  double search_width = 0.12;   // of the template while searching, particle radii
  double judging_width = 0.05;  // and when alignments are compared
};

struct Match {
  Pose first_from_second;
  /// Sum over both views of the mean, over its localisations, of ln(density under the other view) -
  /// ln(density of what was not seen). Natural logarithm; 0 where views have nothing to do with each other.
  double evidence = 0;
  /// Localisations of either that lie where the other view looked, and the mean of these logarithms over
  /// them: how well the views agree where both looked, however much that is.
  double seen = 0, fit = 0;
};

class PairSearch {
 public:
  /// Localisations `subset` of the views `which`; their first ones must be a fair sample.
  PairSearch(const Views& views, const std::vector<Eigen::Vector3f>& axes, const Subsets& subset,
             const std::vector<int>& which, const PairSearchOptions& options = {});
  ~PairSearch();

  /// The best alignment of view which[first] with each of which[second[...]].
  std::vector<Match> matches(std::size_t first, const std::vector<std::size_t>& second,
                             const Eigen::Matrix3f& turn) const;

  /// The alignment that refining `first_from_second` leads to.
  Match refined(std::size_t first, std::size_t second, const Pose& first_from_second) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polar
