// The script that Slurm runs for a batch, from ours (configs/batch_slurm.sh) or a centre's own.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace polar::pipeline {

namespace scripts {
/// The files that are part of the program, by name.
const std::map<std::string, std::string>& embedded_texts();
}  // namespace scripts

/// What a template's {{names}}, {{polar}} and {{restarts}} stand for.
struct SlurmScript {
  std::vector<std::string> names;  // of the data sets, task 1 first
  std::vector<std::string> polar;  // `polar batch CONFIG ...` of every task and of the tables
  int restarts = 0;                // of a task that ran out of its time
};

/// `from` names the template in faults. Throws smlm::Error (usage) for one that asks for something else, or
/// not for the names and the program.
std::string slurm_script_text(const SlurmScript& script, const std::string& text, const std::string& from);

}  // namespace polar::pipeline
