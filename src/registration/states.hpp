// The states of a registration as bytes, for a checkpoint. One list of fields serves both directions; a
// member that is added to a struct and not to its list does not compile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "byte_archive.hpp"
#include "polar/registration/checkpoint.hpp"
#include "polar/registration/registration.hpp"
#include "refine/refine.hpp"

namespace polar {

/// What is known when coarse poses of all views are found.
struct CoarseState {
  std::vector<Pose> pose;  // template_from_view
  bool crowded = false;    // of which problem they are
  std::string group = "C1";
  NoiseModel noise;  // by which bursts are told apart
  bool continuous = false;
  std::optional<Symmetry> symmetry;
  std::vector<StartReport> starts;
  double agreement = 0;
  std::string weights_sha256;
  std::vector<std::string> warnings;
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
void fields(Archive& archive, SymmetryTrial& value) {
  auto& [group, similarity, gain, gain_std] = value;
  archive(group, similarity, gain, gain_std);
}
template <class Archive>
void fields(Archive& archive, Symmetry& value) {
  auto& [asked, in_use, group, canonical_from_template, gain, gain_std, tried, unit, unit_share] = value;
  archive(asked, in_use, group, canonical_from_template, gain, gain_std, tried, unit, unit_share);
}
template <class Archive>
void fields(Archive& archive, StartReport& value) {
  auto& [name, held_out, gain, gain_std, won] = value;
  archive(name, held_out, gain, gain_std, won);
}
template <class Archive>
void fields(Archive& archive, RoundReport& value) {
  auto& [width, moved, escaped, held_out] = value;
  archive(width, moved, escaped, held_out);
}
template <class Archive>
void fields(Archive& archive, CoarseState& value) {
  auto& [pose, crowded, group, noise, continuous, symmetry, starts, agreement, weights_sha256, warnings] =
      value;
  bool has = symmetry.has_value();
  Symmetry known = symmetry.value_or(Symmetry{});
  archive(pose, crowded, group, noise, continuous, has, known, starts, agreement, weights_sha256, warnings);
  if (has) symmetry = known;
}
template <class Archive>
void fields(Archive& archive, Fit& value) {
  auto& [mixture, pose, noise, group, margin, occupancy, evidence, history, rounds, escaped] = value;
  archive(mixture, pose, noise, group, margin, occupancy, evidence, history, rounds, escaped);
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
