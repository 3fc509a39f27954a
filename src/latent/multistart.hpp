// FLAMES, descent from each minimum, escape test and update (paper III.E, eq. 14 and 15), the template held.
#pragma once

#include <vector>

#include "descent.hpp"
#include "flames_search.hpp"
#include "polar/core/progress.hpp"

namespace polar {

class Multistart {
 public:
  /// Where `progress` is cancelled, improve() leaves the views that are left as they are.
  Multistart(const Autoencoder& model, const LatentOptions& options, bool planar, std::size_t views,
             const Progress& progress);

  /// The `most` best minima of every view over the grid, turned at random for each `round`.
  std::vector<std::vector<Minimum>> minima(const LatentViews& views, const Eigen::Matrix3Xf& points,
                                           const PosedViews& state, int round, int most) const;

  /// Descends from the best minima of the views `which` (and, where the template is new to them, the present
  /// poses) and takes what is better. Returns the views that escaped.
  std::vector<int> improve(const LatentViews& views, const Eigen::Matrix3Xf& points, int round,
                           bool present_too, const std::vector<int>& which, PosedViews& state);

  /// For each view the best pose found at least T_R away from its own; loss -1: there is none.
  const std::vector<DescendedPose>& second() const { return second_; }

 private:
  std::vector<DescendedPose> descended(const LatentView& view, const Eigen::Matrix3Xf& points,
                                       const std::vector<Pose>& starts) const;
  bool update(std::size_t i, const std::vector<DescendedPose>& found, PosedViews& state);

  const Autoencoder& model_;
  const LatentOptions& options_;
  const Progress& progress_;
  bool planar_;
  SearchGrid grid_;
  std::vector<DescendedPose> second_;
};

}  // namespace polar
