// `polar batch --slurm`: every data set of a batch as a task of a Slurm array, and a last job for the tables.
#pragma once

#include <string>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/pipeline/batch.hpp"

namespace polar {

struct SlurmOptions {
  std::string partition{};  // empty: the cluster's default
  std::string time{};       // limit of a task as sbatch reads it (minutes, HH:MM:SS); empty: the partition's
  std::string memory{};     // of a task as sbatch reads it (16G); empty: the partition's
  int cpus = 1;             // threads of a task
  int at_once = 0;          // tasks at a time; 0: as many as the cluster grants
  int notice_s = 120;       // a task is told so long before its limit, and leaves a checkpoint
  int restarts = 10;        // of a task that ran out of its time
  std::vector<std::string> more{};  // options of sbatch without their dashes: account=imaging, qos=short
  std::string template_file{};      // instead of configs/batch_slurm.sh
};

struct SlurmBatch {
  std::vector<std::string> names;   // of the data sets to run, task 1 first; empty: all are complete
  std::string directory;            // of the batch
  std::string script_file, script;  // where it is written, and its text
  std::vector<std::string> tasks;   // sbatch ... script_file: the array
  std::vector<std::string> tables;  // sbatch ... : what comes after it, but for the dependency on its number
};

/// What would be submitted. `polar` are the words that run this batch: program, `batch`, configuration and
/// what of the command line holds for every data set. Data sets that cannot be run are noted, and left to
/// their tasks. Throws smlm::Error (usage) for a wrong name in `flags.only` or a template that cannot be
/// used.
SlurmBatch slurm_batch(const BatchConfig& config, const BatchFlags& flags, const SlurmOptions& options,
                       const std::vector<std::string>& polar, Progress& progress);

/// The script, followed by comments that say how it is submitted.
std::string slurm_text(const SlurmBatch& batch);

/// Writes the script and submits both jobs; lines for stdout. Throws smlm::Error, (io) where the script
/// cannot be written, (resource) where there is no sbatch or it refuses.
std::vector<std::string> submit(const SlurmBatch& batch);

}  // namespace polar
