// What `polar fit` and `polar modes` share: their input, and how they tell of their work.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "polar/core/parallel.hpp"
#include "polar/pipeline/placed_particles.hpp"
#include "reporter.hpp"

namespace polar::cli {

struct Manner {
  int threads = 0;
  bool quiet = false, json_log = false;

  ReportStyle style() const { return choose_style(quiet, json_log); }
};

inline void add_input_options(CLI::App& sub, PlacedInput& input) {
  sub.add_option("input", input.inputs, "result directory, results.h5, or localisation tables")->required();
  sub.add_option("--poses", input.poses, "poses.csv of the tables' particles");
  sub.add_option("--set", input.overrides, "input.key=value: how tables are read");
}

inline void add_manner_options(CLI::App& sub, Manner& manner, std::uint64_t& seed, bool& overwrite) {
  sub.add_option("--seed", seed, "every random choice follows from it");
  sub.add_option("--threads", manner.threads,
                 "0: all that the machine grants; the result is the same for any number")
      ->check(CLI::Range(0, 4096));
  sub.add_flag("--quiet", manner.quiet, "no progress, no warnings");
  sub.add_flag("--json-log", manner.json_log, "progress and warnings as JSON lines on stderr");
  sub.add_flag("--overwrite", overwrite, "replace what is there");
}

}  // namespace polar::cli
