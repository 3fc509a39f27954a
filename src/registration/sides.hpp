// Crops of one side of a structure may be posed against those of the other side, half a turn about the line
// from side to side. Each side then agrees within itself, no view gains by changing over, and pairs of views
// say nothing: only all views of a side together do.
#pragma once

#include <vector>

#include "rounds.hpp"

namespace polar {

/// Where held-out localisations are explained better with the views of one side turned: turns these in
/// `state` and returns all views; else returns none. Not asked: views that hardly differ in what they show,
/// or have few localisations.
std::vector<int> turn_side(const Problem& problem, RoundState& state);

}  // namespace polar
