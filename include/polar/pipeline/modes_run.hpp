// `polar modes`: how the particles of a result differ.
#pragma once

#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/fitting/modes.hpp"
#include "polar/pipeline/placed_particles.hpp"

namespace polar {

struct ModesRunOptions {
  PlacedInput input;
  std::string sites;      // table of x, y, z in the template frame; empty: found, else landmarks
  int landmarks = 32;     // where sites cannot be told apart
  std::string directory;  // to write into; empty: modes beside the input
  bool overwrite = false;
  fitting::ModesOptions modes;
  std::string command{};  // as typed; kept in modes.json
};

/// Writes modes.csv (a line a mode), scores.csv (a line a particle), mode_sites.csv (the average at -2, 0 and
/// +2 standard deviations of each mode), mode_<n>.png of the modes above noise, and modes.json. Returns the
/// lines to show the user. Throws smlm::Error.
std::vector<std::string> run_modes(const ModesRunOptions& options, Progress& progress);

}  // namespace polar
