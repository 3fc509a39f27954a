// Is there a structure at all? The template has to explain localisations that it has not seen better than a
// cloud does: the template itself, turned any way.
#pragma once

#include "../data/evidence.hpp"
#include "polar/registration/engine_options.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// Fills verdict, its sentence and the gain over the cloud; rejects all views where there is no structure.
void judge_registration(const Evidence& cloud, const Evidence& evidence, const VerdictOptions& options,
                        Registration& out);

}  // namespace polar
