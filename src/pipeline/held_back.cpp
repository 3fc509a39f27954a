#include "held_back.hpp"

#include <algorithm>

#include "smlm/error.hpp"

namespace polar::pipeline {

HeldBack::HeldBack(smlm::ParticleSet& set, const smlm::ChannelOptions& channel,
                   const smlm::ParticleLimits& limits, Progress& progress) {
  for (const smlm::Particle& particle : set.particles) rows_.push_back(particle.rows);
  if (!channel_column(channel).empty()) hold_channels(set, channel, progress);
  hold_unfit(set, limits, progress);
}

void HeldBack::hold_channels(smlm::ParticleSet& set, const smlm::ChannelOptions& channel,
                             Progress& progress) {
  const smlm::Channels channels = smlm::channels_of(set.table, channel_column(channel));
  const std::vector<bool> registers = registering_channels(channels, channel);
  std::vector<std::size_t> count(channels.names.size(), 0);
  for (smlm::Particle& particle : set.particles) {
    const auto held = [&](std::uint32_t row) {
      const std::int32_t c = channels.row[row];
      if (c >= 0) ++count[static_cast<std::size_t>(c)];
      return c < 0 || !registers[static_cast<std::size_t>(c)];
    };
    particle.rows.erase(std::remove_if(particle.rows.begin(), particle.rows.end(), held),
                        particle.rows.end());
  }
  for (std::size_t c = 0; c < count.size(); ++c)
    progress.note("channel " + channels.names[c] + ": " + std::to_string(count[c]) + " localisations, " +
                  (registers[c] ? "decides the poses" : "is carried along"));
}

void HeldBack::hold_unfit(smlm::ParticleSet& set, const smlm::ParticleLimits& limits, Progress& progress) {
  unfit_ = smlm::unfit_particles(set, limits);
  if (unfit_.empty()) return;
  const std::string of = std::to_string(unfit_.size()) + " of " + std::to_string(set.particles.size());
  if (set.particles.size() < unfit_.size() + 2)
    throw smlm::Error(smlm::Fault::input, "input.particle_limits", "leaves out " + of + " particles",
                      "at least two are needed: widen the limits");
  for (const smlm::UnfitParticle& u : unfit_) set.particles[u.particle].rows.clear();
  progress.note("warning: " + of + " particles left out by input.particle_limits");
}

void HeldBack::put_back(Results& results) {
  for (std::size_t i = 0; i < rows_.size(); ++i) results.particles.particles[i].rows = std::move(rows_[i]);
  for (const smlm::UnfitParticle& u : unfit_) {
    RegisteredView& view = results.registration.view[u.particle];
    view.accepted = false;
    view.reason = u.reason;
  }
}

}  // namespace polar::pipeline
