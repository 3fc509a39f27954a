// `polar batch`: many data sets, each in a process of its own, and the tables that compare them.
#pragma once

#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/pipeline/batch_config.hpp"
#include "polar/pipeline/run.hpp"

namespace polar {

/// What of a batch a process does: all, or its share where other processes, on other machines, do the rest.
enum class BatchPart {
  whole,
  data_sets,  // runs the wanted ones, looks at no other and writes no tables
  tables      // runs nothing: the wanted ones have been run as data_sets
};

struct BatchFlags {
  std::vector<std::string> only;  // names of data sets to run; empty: all
  int jobs = 1;                   // data sets at a time
  int threads = 0;                // of all jobs together; 0: what the machine grants
  bool overwrite = false;         // replace results of another input or configuration
  std::string command{};          // as typed; kept in every record
  BatchPart part = BatchPart::whole;
};

/// Whether `only` names it or names none.
bool is_wanted(const BatchFlags& flags, const std::string& name);
/// Throws smlm::Error (usage) for a name in `only` that is none.
void require_known_names(const BatchConfig& config, const BatchFlags& flags);

struct BatchOutcome {
  bool cancelled = false;
  bool some_failed = false;
  std::vector<std::string> summary;  // lines for stdout
};

/// Runs every data set into a folder of its name. A complete result of the same input and configuration is
/// kept, a run that was cut short continues, and a data set that fails, however it does, stops no other.
/// summary.csv, conditions.csv and batch.json are written at the beginning and whenever a data set ends; they
/// say what the folders hold. report.html shows it at the end. The two parts of a batch come to the same: a
/// data set that does not end well leaves a word of it for the tables. Call it while this process has no
/// other thread. Throws smlm::Error (usage) for a name in `only` that is none, (io) when the output directory
/// cannot be written.
BatchOutcome run_batch(const BatchConfig& config, const BatchFlags& flags, Progress& progress,
                       const Engine& engine = default_engine());

}  // namespace polar
