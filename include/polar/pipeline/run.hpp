// `polar run`: read, group, prepare, register, write.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/pipeline/run_config.hpp"
#include "polar/registration/checkpoint.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

struct RunFlags {
  bool overwrite = false;  // replace what an earlier run wrote
  bool resume = false;     // keep a complete result of the same computation, continue one that was cut short;
                           // with overwrite, too, only that of another computation is replaced
  std::string command{};   // as typed; kept in the record
};

struct RunOutcome {
  bool cancelled = false;            // no result was written
  bool resumable = false;            // but a checkpoint
  std::vector<std::string> summary;  // lines for stdout
};

/// The engine; tests put another one in its place.
using Engine = std::function<Registration(const Views&, const RegistrationOptions&, Progress&, Checkpoint&)>;

/// register_views.
Engine default_engine();

/// Whether output.directory holds the complete result of this very computation: the same content of the input
/// and the same configuration. Throws smlm::Error where the input cannot be read.
bool is_complete(const RunConfig& config);

/// Checks and locks the output directory first, computes, then writes every file whole, summary.json last: a
/// directory with summary.json is complete. Throws smlm::Error (see docs/faults.md).
RunOutcome run(const RunConfig& config, const RunFlags& flags, Progress& progress, const Engine& engine);

/// The same with the default engine.
RunOutcome run(const RunConfig& config, const RunFlags& flags, Progress& progress);

}  // namespace polar
