// The symmetric units of an averaged structure whose sites cannot be told apart, and how many of them every
// particle shows.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "polar/results/labelling.hpp"
#include "polar/results/results.hpp"

namespace polar {

struct UnitOccupancy {
  PlaceCounts counts;                   // of the accepted particles; empty: they are not counted
  std::string reason = "never looked";  // why they are not counted; empty: they are
};

/// A unit is the part of the fused template that lies nearest to the unit's spot. `background`: density of
/// localisations that belong to none, nm^-3 (planar nm^-2), and `background_share`, of the localisations:
/// first guesses. Units count where they lie farther from one another than three standard deviations of a
/// unit's own localisations.
UnitOccupancy occupied_units(const smlm::LocalisationTable& superparticle, const TemplateSites& fused,
                             const Eigen::Matrix3Xd& unit_nm, double background, double background_share);

}  // namespace polar
