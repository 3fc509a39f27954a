// A symmetry found is a claim to be tested: is the average without it better? Under the group every view has
// as many poses as the group elements; each view chooses among these images, and the labels follow.
#pragma once

#include "../refine/refine.hpp"
#include "polar/registration/engine_options.hpp"

namespace polar {

struct Relaxation {
  Fit fit;          // without the group: each view at its likeliest image, weights as labels are seen there
  Comparison gain;  // over the symmetric one, nat a label: views judged by what other views say
};

Relaxation relaxed(const Problem& problem, const EngineOptions& options, const Fit& symmetric);

}  // namespace polar
