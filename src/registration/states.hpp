// The states of a registration as bytes, for a checkpoint. One list of fields serves both directions; a
// member that is added to a struct and not to its list does not compile.
#pragma once

#include <string>

#include "ab_initio.hpp"
#include "byte_archive.hpp"
#include "polar/registration/checkpoint.hpp"
#include "starts.hpp"

namespace polar {

/// What a registration is before its poses are polished.
struct FusedState {
  RoundState state;
  NoiseModel noise;
};

/// What run_rounds is between two rounds.
struct RoundsUnderWay {
  int round = 0;
  bool searching = true;
  RoundState state, best;
};

namespace states {

template <class Archive>
void fields(Archive& archive, Pose& value) {
  auto& [rotation, translation] = value;
  archive(rotation, translation);
}
template <class Archive>
void fields(Archive& archive, Mixture& value) {
  auto& [centre, weight, outlier_fraction, outlier_density] = value;
  archive(centre, weight, outlier_fraction, outlier_density);
}
template <class Archive>
void fields(Archive& archive, NoiseModel& value) {
  auto& [lateral_factor, axial_factor, lateral_extra, axial_extra, width, planar] = value;
  archive(lateral_factor, axial_factor, lateral_extra, axial_extra, width, planar);
}
template <class Archive>
void fields(Archive& archive, Hypothesis& value) {
  auto& [name, number, crowded, one_view, mixture, pose, held_out] = value;
  archive(name, number, crowded, one_view, mixture, pose, held_out);
}
template <class Archive>
void fields(Archive& archive, RoundState& value) {
  auto& [mixture, pose, margin, crowded, one_view, occupancy, group, sites, width, held_out, rounds, escaped,
         twins, cut, far, structureless] = value;
  archive(mixture, pose, margin, crowded, one_view, occupancy, group, sites, width, held_out, rounds, escaped,
          twins, cut, far, structureless);
}
template <class Archive>
void fields(Archive& archive, RoundsUnderWay& value) {
  auto& [round, searching, state, best] = value;
  archive(round, searching, state, best);
}
template <class Archive>
void fields(Archive& archive, FusedState& value) {
  auto& [state, noise] = value;
  archive(state, noise);
}
template <class Archive>
void fields(Archive& archive, StartReport& value) {
  auto& [name, held_out, final_held_out, won] = value;
  archive(name, held_out, final_held_out, won);
}
template <class Archive>
void fields(Archive& archive, StartsOutcome& value) {
  auto& [winner, report, agreement, finished] = value;
  archive(winner, report, agreement, finished);
}

}  // namespace states

template <class State>
void keep(Checkpoint& checkpoint, const std::string& name, State& state) {
  states::Writer writer;
  writer(state);
  checkpoint.keep(name, std::move(writer.bytes));
}

/// Whether the state was kept; `state` is then what it was.
template <class State>
bool restore(Checkpoint& checkpoint, const std::string& name, State& state) {
  const std::optional<std::string> bytes = checkpoint.load(name);
  if (!bytes) return false;
  states::Reader reader(*bytes);
  reader(state);
  reader.require_end();
  return true;
}

}  // namespace polar
