// A start for views that show parts of the structure: pairs of views are registered with each other, and the
// surest pairs join groups until one is left (a maximum spanning tree). No template is needed, which parts
// laid over each other would spoil.
#pragma once

#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/progress.hpp"
#include "polar/fusion/pair_search.hpp"
#include "problem.hpp"
#include "rounds.hpp"

namespace polar {

/// An alignment of two views by their place in a list.
struct Joint {
  std::size_t first = 0, second = 0;
  Match match;
};

/// Poses template_from_view of `views` views from the surest joints that connect them; the first view is at
/// rest. Views that no joint reaches are at rest too.
std::vector<Pose> spanning_poses(std::size_t views, std::vector<Joint> joints);

class Assembly {
 public:
  explicit Assembly(const Problem& problem);

  /// Do poses of all views contradict what a few pairs of views say by themselves? False where pairs say
  /// little.
  bool contradicts(const std::vector<Pose>& template_from_view) const;

  /// A template of the assembled views and their poses; the other views are at rest. `cut`: views are cut by
  /// planes, and none holds strands. Meaningless when cancelled.
  RoundState assembled(const RoundOptions& options, bool cut, Progress& progress) const;

 private:
  const Problem& problem_;
  std::vector<int> which_;  // views that take part
  PairSearch pairs_;
};

}  // namespace polar
