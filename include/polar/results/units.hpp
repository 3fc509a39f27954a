// The symmetric units of an averaged structure whose sites cannot be told apart, and how many of them every
// particle shows.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "polar/results/results.hpp"

namespace polar {

struct UnitOccupancy {
  int units = 0;                        // of the template; 0: they are not counted
  std::vector<int> occupied;            // units with a label, of every accepted particle
  std::string reason = "never looked";  // why they are not counted; empty: they are
};

/// A unit is the part of the fused template that lies nearest to the unit's spot. A particle shows the
/// units without which its localisations are much less likely, the less so the more often units are there
/// at all. `background`: density of localisations that belong to none, nm^-3 (planar nm^-2), its share
/// included. Units count where they lie farther from one another than four standard deviations of a
/// unit's own localisations.
UnitOccupancy occupied_units(const smlm::LocalisationTable& superparticle, const TemplateSites& fused,
                             const Eigen::Matrix3Xd& unit_nm, double background);

}  // namespace polar
