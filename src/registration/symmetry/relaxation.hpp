// A symmetry found is a claim to be tested: is the average without it better? Under the group every view has
// as many poses as the group elements; each view chooses among these images, and the template follows.
#pragma once

#include "../refine/refine.hpp"
#include "polar/registration/engine_options.hpp"

namespace polar {

/// The best of a few tries to do without the group of `symmetric`, at its noise and width; no new search.
Fit relaxed(const Problem& problem, const Refiner& refiner, const EngineOptions& options,
            const Fit& symmetric);

}  // namespace polar
