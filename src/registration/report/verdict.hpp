// Is there a structure at all? The template has to explain localisations that it has not seen better than a
// cloud does: round, with the radial profile of the views.
#pragma once

#include "../data/evidence.hpp"
#include "../data/problem.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// Of the best structureless hypothesis: shells about the centre of every view, fitted to fitted localisations.
Evidence cloud_evidence(const Problem& problem);

/// Fills verdict, its sentence and the gain over the cloud; rejects all views where there is no structure.
void judge_registration(const Problem& problem, const Evidence& evidence, const VerdictOptions& options,
                        Registration& out);

}  // namespace polar
