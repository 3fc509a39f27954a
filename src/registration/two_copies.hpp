// A template may hold two copies of the structure, turned against each other, each fitted by its own views:
// no view gains by changing over, so searches end there.
#pragma once

#include <vector>

#include "rounds.hpp"

namespace polar {

/// The views that fit the copy with more of them, where the views fall into two groups by the centres they
/// show; else none.
std::vector<int> views_of_one_copy(const Problem& problem, const RoundState& state);

/// Where pairs of views say that some of them lie half a turn off, an angle by which the template looks
/// nearly the same: turns these back in `state` and returns the views, 50 at most, that were asked; else
/// returns none.
std::vector<int> turn_back(const Problem& problem, RoundState& state);

}  // namespace polar
