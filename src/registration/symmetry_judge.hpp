// Does the structure have this group? Held-out localisations say it.
#pragma once

#include <vector>

#include "jury.hpp"

namespace polar {

/// Template and poses in the group's own frame, the template symmetric: images of one site are merged. The
/// occupancy's prior keeps its weight in localisations of a view, however many centres there are now.
RoundState with_group(RoundState state, const NoiseModel& noise, const RotationGroup& group,
                      const Pose& canonical_from_template);

/// Mean log density per held-out localisation above the template without a group, and its standard error:
/// views are independent, their localisations are not.
struct SymmetryGain {
  double mean = 0, std = 0;
};

/// Fits template and poses again with and without a group, and compares. Every view has its own occupancy on
/// both sides: registration turns the bright sites of symmetric particles onto one another, and a template
/// that remembers where would win against the symmetric one for nothing else.
class SymmetryJudge {
 public:
  SymmetryJudge(const Problem& problem, const NoiseModel& noise, const RoundState& state);
  SymmetryGain gain(const RotationGroup& group, const Pose& canonical_from_template) const;

 private:
  std::vector<double> verdict(RoundState state) const;  // summed log density of every view of the jury

  const Problem& problem_;
  NoiseModel noise_;
  RoundState state_;
  Jury jury_;
  std::vector<double> plain_;
};

}  // namespace polar
