#include "polar/pipeline/slurm.hpp"

#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "batch_files.hpp"
#include "program.hpp"
#include "shell_text.hpp"
#include "slurm_script.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using Words = std::vector<std::string>;
using pipeline::shell_word;
using pipeline::shell_words;

constexpr const char* kShippedTemplate = "batch_slurm.sh";
constexpr const char* kAfter = "--dependency=afterany:";  // whatever became of the tasks

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  std::error_code unseen;
  if (!in.is_open() || in.bad() || !std::filesystem::is_regular_file(path, unseen))
    throw smlm::Error(smlm::Fault::usage, path, "cannot be read", "correct --template");
  return text;
}

// What is not yet complete. That a data set cannot be run may have changed when its task begins.
Words to_be_run(const BatchConfig& config, const BatchFlags& flags, Progress& progress) {
  Words names;
  for (const DatasetConfig& d : config.datasets) {
    if (!is_wanted(flags, d.name)) continue;
    try {
      if (d.fault.empty() && is_complete(d.run)) continue;
    } catch (const smlm::Error&) {  // the task will say so
    }
    if (!d.fault.empty()) progress.note("warning: " + d.name + ": " + d.fault);
    names.push_back(d.name);
  }
  return names;
}

// In a pattern of file names of Slurm, % is special.
std::string plain_pattern(const std::string& path) {
  std::string out;
  for (const char c : path) out += c == '%' ? "%%" : std::string(1, c);
  return out;
}

Words options_of_both(const SlurmOptions& options, const std::string& directory) {
  Words words = {"sbatch", "--parsable", "--open-mode=append",
                 "--job-name=polar-" + std::filesystem::path(directory).filename().string()};
  if (!options.partition.empty()) words.push_back("--partition=" + options.partition);
  if (!options.time.empty()) words.push_back("--time=" + options.time);
  if (!options.memory.empty()) words.push_back("--mem=" + options.memory);
  for (const std::string& option : options.more) words.push_back("--" + option);
  return words;
}

// "17" of "17" or of "17;cluster".
std::string submitted(const Words& command) {
  const pipeline::ProgramEnd end = pipeline::run_program(command);
  std::string said = end.errors.substr(0, end.errors.find_last_not_of(" \n") + 1);
  const std::string number = end.output.substr(0, end.output.find_first_not_of("0123456789"));
  if (end.code != 0 || number.empty())
    throw smlm::Error(smlm::Fault::resource, "sbatch",
                      "the jobs were not taken" + (said.empty() ? "" : ": " + said),
                      "--print shows the script and both commands");
  return number;
}
}  // namespace

SlurmBatch slurm_batch(const BatchConfig& config, const BatchFlags& flags, const SlurmOptions& options,
                       const Words& polar, Progress& progress) {
  require_known_names(config, flags);
  SlurmBatch batch;
  batch.directory = config.directory;
  const std::string folder = config.directory + "/" + pipeline::kBatchTasks + "/";
  batch.script_file = folder + "batch.sh";
  batch.names = to_be_run(config, flags, progress);
  const bool own = !options.template_file.empty();
  batch.script = pipeline::slurm_script_text(
      {batch.names, polar, options.restarts},
      own ? content_of(options.template_file) : pipeline::scripts::embedded_texts().at(kShippedTemplate),
      own ? options.template_file : kShippedTemplate);
  batch.tasks = batch.tables = options_of_both(options, config.directory);
  const std::string limit = options.at_once > 0 ? "%" + std::to_string(options.at_once) : "";
  for (const std::string& word :
       {"--array=1-" + std::to_string(batch.names.size()) + limit, std::string("--requeue"),
        "--signal=B:USR1@" + std::to_string(options.notice_s),
        "--cpus-per-task=" + std::to_string(options.cpus), "--output=" + plain_pattern(folder) + "%A_%a.log"})
    batch.tasks.push_back(word);
  batch.tables.push_back("--output=" + plain_pattern(folder) + "%j.log");
  batch.tasks.push_back(batch.script_file);
  batch.tables.push_back(batch.script_file);
  return batch;
}

std::string slurm_text(const SlurmBatch& batch) {
  Words after = batch.tables;
  const std::string program = after.front();
  after.erase(after.begin());
  std::string how = "\nSubmitted by:\njob=$(" + shell_words(batch.tasks) + ")\n" + program + " " + kAfter +
                    "$job " + shell_words(after);
  std::string text = batch.script;
  for (const char c : how) text += c == '\n' ? "\n# " : std::string(1, c);
  return text + "\n";
}

Words submit(const SlurmBatch& batch) {
  std::error_code unseen;
  std::filesystem::create_directories(std::filesystem::path(batch.script_file).parent_path(), unseen);
  smlm::write_file_atomically(batch.script_file, slurm_text(batch));
  const std::string tasks = submitted(batch.tasks);
  Words tables = batch.tables;
  tables.insert(tables.begin() + 1, kAfter + tasks);
  std::string last;
  try {
    last = submitted(tables);
  } catch (const smlm::Error& e) {
    throw smlm::Error(smlm::Fault::resource, "",
                      std::string(e.what()) + " (job " + tasks +
                          " with the data sets was taken: --gather makes "
                          "the tables once it has ended)");
  }
  return {"submitted    " + std::to_string(batch.names.size()) + " data sets as job " + tasks +
              ", the tables as job " + last,
          "script       " + batch.script_file, "results      " + batch.directory};
}

}  // namespace polar
