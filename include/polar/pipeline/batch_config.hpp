// The configuration of `polar batch`: many data sets, one run configuration each (configs/batch.yaml).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/pipeline/run_config.hpp"

namespace polar {

/// How the uncertainty of a condition's mean is found: by drawing its data sets again, with repetition.
struct BootstrapOptions {
  int draws = 10000;       // of data sets
  double level = 0.95;     // probability that an interval holds
  std::uint64_t seed = 1;  // of the draws
};

/// One sentence per fault, each starting with its key; empty when the options can be used.
std::vector<std::string> violations(const BootstrapOptions& options);

struct DatasetConfig {
  std::string name;       // of its folder in the output directory
  std::string condition;  // data sets of the same text are compared with those of another
  RunConfig run;
  /// Why it cannot be run; empty: it can. A file that is missing fails this data set, not the batch.
  std::string fault;
  int fault_code = 0;
};

struct BatchConfig {
  std::string directory = "batch";  // holds a folder a data set and the tables over all
  std::vector<DatasetConfig> datasets;
  BootstrapOptions bootstrap;
};

/// Reads the file. `overrides` (`section.key=value`) go to the run of every data set and win over all else.
/// Throws smlm::Error (usage).
BatchConfig load_batch_config(const std::string& path, const std::vector<std::string>& overrides);

/// Puts the results below another directory.
void move_batch(BatchConfig& config, const std::string& directory);

}  // namespace polar
