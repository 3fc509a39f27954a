// How densely localisations lie that belong to no place: what tells a stray from a label's only localisation.
#pragma once

#include <functional>

#include "smlm/localisation_table.hpp"

namespace polar::results {

/// In nm^-3 (planar nm^-2), of a background that fills an ellipsoid evenly, by the covariance of the
/// localisations that belong to it; a ball or a round pick has that density, a box all but an eighth. Beyond
/// the ellipsoid nothing else is either, so that it does not matter there. `belongs`: probability of a row.
/// `otherwise`: where too few belong to tell.
double background_density(const smlm::LocalisationTable& table,
                          const std::function<double(std::size_t)>& belongs, double otherwise);

}  // namespace polar::results
