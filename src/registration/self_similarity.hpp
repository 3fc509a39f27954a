// How well a template fits on itself after a turn: what a search for symmetry axes asks. It knows the
// template only, no localisation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/direction_volumes.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

class SelfSimilarity {
 public:
  SelfSimilarity(const Mixture& mixture, bool planar);

  /// Of the turn about `centre`: 1 for none, 0 for the mean over all turns, in between linear in the mean log
  /// density of the template's centres under the template, drawn as wide as a search draws it. Fast:
  /// look-ups.
  double coarse(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) const;
  /// The mean over several motions of the template, from the exact density.
  double exact(const std::vector<Pose>& motion) const;

  /// Mean of the template; every symmetry axis of a template that has one goes through it.
  Eigen::Vector3d centroid() const { return centroid_; }
  /// Log density that the template loses by a turn at random, per localisation. Small: it looks like a
  /// sphere.
  double contrast() const { return exact_own_ - exact_any_; }
  bool planar() const { return views_.planar; }

 private:
  double log_density(const std::vector<Pose>& motion) const;

  Mixture mixture_;
  Views views_;  // one view: the centres
  SigmaClasses classes_;
  DirectionVolumes volumes_;
  SearchView search_view_;
  Eigen::Vector3d centroid_;
  double coarse_own_ = 0, coarse_any_ = 0, exact_own_ = 0, exact_any_ = 0;
};

/// How many of `moved` went to where the template looks the same: a turn of a symmetric structure, or of one
/// that is nearly so. Poses are template_from_view, of all views.
int twins(const Mixture& mixture, bool planar, const std::vector<Pose>& before,
          const std::vector<Pose>& after, const std::vector<std::size_t>& moved);

}  // namespace polar
