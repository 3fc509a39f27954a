// Where in a template the axes of a rotation group lie.
#pragma once

#include <string>

#include "polar/core/pose.hpp"
#include "self_similarity.hpp"

namespace polar {

/// A group and its place. `similarity`: mean over its turns of SelfSimilarity::exact.
struct SymmetryFrame {
  std::string group;
  Pose canonical_from_template;
  double similarity = 0;
};

/// The place that fits best, whether the template has the group or not. Planar: C<n> only, about z. One that
/// has no prospect of a similarity of `worthwhile` is not refined.
SymmetryFrame best_frame(const SelfSimilarity& of_template, const std::string& group, double worthwhile);

}  // namespace polar
