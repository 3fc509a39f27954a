// What a fit says of every view and of itself.
#pragma once

#include "../refine/refine.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// Last poses by least squares on all localisations, covariances from the spread of their bursts' gradients,
/// what is accepted and why not; the template and the calibration.
void report_views(const Problem& problem, const EngineOptions& options, Fit& fit, Registration& out);

FusedTemplate fused_template(const Fit& fit);

}  // namespace polar
