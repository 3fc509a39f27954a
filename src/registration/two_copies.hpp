// A template may hold two copies of the structure, turned against each other, each fitted by its own views:
// no view gains by changing over, so searches end there.
#pragma once

#include <vector>

#include "rounds.hpp"

namespace polar {

/// The views that fit the copy with more of them, where the views fall into two groups by the centres they
/// show; else none.
std::vector<int> views_of_one_copy(const Problem& problem, const RoundState& state);

}  // namespace polar
