// Poses by the names of particles.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "polar/core/pose.hpp"

namespace polar::pipeline {

using NamedPoses = std::map<std::string, std::optional<Pose>>;

/// Of a poses.csv. Throws smlm::Error (input), also for a particle that occurs twice.
NamedPoses read_named_poses(const std::string& path);

}  // namespace polar::pipeline
