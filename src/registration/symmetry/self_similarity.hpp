// How well a template fits on itself after a turn: what a search for symmetry axes asks. It knows the
// template's density only, no localisation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/density_grid.hpp"

namespace polar {

class SelfSimilarity {
 public:
  /// `blur`: widens the density first, so that noise in it is no structure; particle radii.
  SelfSimilarity(DensityGrid density, double blur);

  /// Of the turn about `centre`: 1 for none, 0 for the mean over all turns, in between linear in the mean log
  /// density of the template's points under the template. Fast: nearest voxels.
  double coarse(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) const;
  /// The mean over several motions of the template, between voxels.
  double exact(const std::vector<Pose>& motion) const;

  /// Mean of the template; every symmetry axis of a template that has one goes through it.
  Eigen::Vector3d centroid() const { return centroid_; }
  /// Log density that the template loses by a turn at random, per point. Small: it looks like a sphere.
  double contrast() const { return exact_own_ - exact_any_; }
  bool planar() const { return density_.frame().planar(); }

 private:
  double log_density(const std::vector<Pose>& motion) const;

  DensityGrid density_;
  float floor_ = 0;  // density that a point outside is given
  LogVolume volume_;
  LookupPoints points_;  // that stand for the template's mass
  Eigen::Vector3d centroid_;
  double coarse_own_ = 0, coarse_any_ = 0, exact_own_ = 0, exact_any_ = 0;
};

}  // namespace polar
