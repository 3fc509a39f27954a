// `registration.initial_poses`: poses that are known beforehand instead of a competition of starts.
#pragma once

#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/progress.hpp"
#include "polar/core/view.hpp"
#include "smlm/particle_set.hpp"

namespace polar::pipeline {

/// Reads a poses.csv and gives every view its pose in the engine's units, by the particle's name. One without
/// a pose there begins unturned at its centre and is searched like the others; how many is a note. Throws
/// smlm::Error (input) where fewer than two particles have one.
std::vector<Pose> initial_poses(const std::string& path, const std::vector<smlm::Particle>& particles,
                                const Normalisation& normalisation, Progress& progress);

}  // namespace polar::pipeline
