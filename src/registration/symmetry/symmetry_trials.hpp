// Which rotation group does the structure have? A hypothesis like any other: the coarse template is annealed
// again under each group that it hints at, and held-out localisations decide.
#pragma once

#include <string>
#include <vector>

#include "../anneal/soft_poses.hpp"
#include "polar/core/progress.hpp"
#include "polar/registration/register.hpp"

namespace polar {

struct SymmetryChoice {
  std::string group = "C1";  // of the largest group that costs no more than the evidence's error
  SoftState state;           // annealed under it, in the group's own frame
  Symmetry report;
  struct Rival {
    std::string group;
    SoftState state;
  };
  std::vector<Rival> rival;  // as good as the evidence tells, and neither contains nor is contained
  bool continuous = false;   // the highest order that is tried cannot be told from the next lower one
};

/// `coarse`: of a competition. Under `asked` (a group's name, or empty) that group is chosen whatever the
/// others say; they are tried all the same, for the report. `posed`: independent starts pose the views alike
/// without any group, which then must gain.
SymmetryChoice choose_symmetry(const Problem& problem, const RegistrationOptions& options,
                               const SoftState& coarse, const std::string& asked, bool posed,
                               Progress& progress);

/// Under which group a template that has `group` is annealed; empty: none.
RotationGroup rotations_of(const std::string& group);

}  // namespace polar
