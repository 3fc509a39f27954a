// What localisations look like where there is nothing to register: a cloud without structure.
#pragma once

#include "problem.hpp"

namespace polar {

/// Mean log density of the held-out localisations under a density that depends on the distance from the
/// centre of the view alone, estimated from the fitted ones.
double structureless_score(const Problem& problem);

/// Whether held-out localisations with this mean log density under a template are explained too little better
/// than by such a cloud: then what was found is noise. Many centres and free poses describe any localisations
/// well that they were fitted to.
bool explains_no_more_than_a_cloud(const Problem& problem, double held_out_score);

}  // namespace polar
