// The checkpoints of a run in its output directory: the last two, so that one can always be read.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "checkpoint_file.hpp"
#include "output_directory.hpp"
#include "polar/core/progress.hpp"
#include "polar/registration/checkpoint.hpp"

namespace polar::pipeline {

/// Names of the files.
const std::vector<std::string>& checkpoint_files();

class CheckpointStore : public Checkpoint {
 public:
  /// `directory` outlives it.
  CheckpointStore(const OutputDirectory& directory, ComputationIdentity identity);

  /// Takes over what an earlier run left; false where it left nothing. The newest checkpoint that is whole
  /// counts, with a note about a later one that is not. Throws smlm::Error (input) when none is whole, or
  /// when one belongs to another computation.
  bool resume(Progress& progress);

  std::optional<std::string> load(const std::string& name) override;
  /// Writes a file only where that takes a small share of the time since the last.
  void keep(const std::string& name, std::string bytes) override;
  void drop(const std::string& prefix) override;

  /// Writes what was not yet written. Returns whether there is a checkpoint.
  bool flush();
  /// The run is complete, or another one begins.
  void remove();

 private:
  using Clock = std::chrono::steady_clock;

  const OutputDirectory& directory_;
  CheckpointContent content_;
  bool dirty_ = false;
  Clock::time_point last_end_{};
  Clock::duration last_took_{};
};

}  // namespace polar::pipeline
