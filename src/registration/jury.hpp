// The views and localisations by which everything but the poses is decided, and the fit of the template to
// them.
#pragma once

#include <vector>

#include "polar/fusion/maximisation.hpp"
#include "rounds.hpp"

namespace polar {

/// Whole views, because a view of which a few localisations are looked at says little about what it shows.
struct Jury {
  std::vector<int> which;
  Subsets fitted;    // of every view of the problem
  Subsets held_out;  // empty for views that are not among `which`
};
Jury jury(const Problem& problem);

std::vector<Pose> poses_of(const RoundState& state, const std::vector<int>& which);

/// Standard deviation of a centre, and the distance within which one view does not tell sites apart.
double typical_spread(const NoiseModel& noise);
double reach_of(const NoiseModel& noise);

/// How the template is fitted once it is found.
MaximisationOptions final_fusion(const RoundState& state);

/// Template and poses of the jury in turn, each view with its own occupancy.
void fuse(const Problem& problem, const NoiseModel& noise, const Jury& jury, const MaximisationOptions& em,
          int sweeps, RoundState& state);

}  // namespace polar
