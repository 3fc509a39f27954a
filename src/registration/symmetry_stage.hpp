// registration.symmetry: the group of the template is found, or imposed, and judged by held-out
// localisations.
#pragma once

#include <string>

#include "polar/registration/symmetry.hpp"
#include "rounds.hpp"

namespace polar {

/// The largest group that costs no held-out likelihood. Changes nothing.
Symmetry detect_symmetry(const Problem& problem, const NoiseModel& noise, const RoundState& state);

/// Moves template and poses into the group's own frame at its best place and makes the template symmetric.
Symmetry impose_symmetry(const Problem& problem, const NoiseModel& noise, const std::string& group,
                         RoundState& state);

/// What a structure that plainly lacks the group loses by it, or empty.
std::string symmetry_warning(const Symmetry& symmetry);

}  // namespace polar
