// From rounds to results: calibrated uncertainties, the number of centres, the last search, the polish.
#pragma once

#include "polar/core/progress.hpp"
#include "polar/fusion/calibration.hpp"
#include "polar/registration/registration.hpp"
#include "rounds.hpp"

namespace polar {

/// Fits noise model and template in turn, everything judged by held-out localisations, and stops where these
/// are explained worse: a template fitted under too much blur clumps, and then asks for more. Returns the
/// noise model.
NoiseModel calibrate_and_fuse(const Problem& problem, int cycles, NoiseModel noise, RoundState& state);

/// Mean log density per held-out localisation, each view weighing the centres in its own way where that
/// explains them better: what starts are compared by where views may show parts of the structure.
double held_out_score_of_parts(const Problem& problem, const NoiseModel& noise, RoundState state);

/// Fewer centres where held-out localisations are explained as well: a few sites instead of a surface.
/// Returns the noise model and how well it explains them.
CalibrationReport choose_centres(const Problem& problem, const NoiseModel& noise, RoundState& state);

/// Poses, covariances, scores and verdicts of all views into `registration`.
void polish_all(const Problem& problem, const NoiseModel& noise, RoundState& state,
                Registration& registration);

}  // namespace polar
