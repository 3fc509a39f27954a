// What takes no part in a registration but belongs to its result: localisations of channels that do not
// decide the poses (input.channel), and particles outside of input.particle_limits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/results/results.hpp"
#include "smlm/channel.hpp"
#include "smlm/particle_limits.hpp"

namespace polar::pipeline {

class HeldBack {
 public:
  /// Takes their rows away; the limits are asked of what is left of a particle then. Throws smlm::Error
  /// (input) where fewer than two particles stay.
  HeldBack(smlm::ParticleSet& set, const smlm::ChannelOptions& channel, const smlm::ParticleLimits& limits,
           Progress& progress);
  /// Gives all rows back, and the reasons why particles were not registered.
  void put_back(Results& results);

 private:
  void hold_channels(smlm::ParticleSet& set, const smlm::ChannelOptions& channel, Progress& progress);
  void hold_unfit(smlm::ParticleSet& set, const smlm::ParticleLimits& limits, Progress& progress);

  std::vector<std::vector<std::uint32_t>> rows_;  // of every particle, all of them
  std::vector<smlm::UnfitParticle> unfit_;
};

}  // namespace polar::pipeline
