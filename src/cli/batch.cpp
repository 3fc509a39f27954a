#include "polar/pipeline/batch.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "polar/pipeline/slurm.hpp"
#include "reporter.hpp"
#include "signals.hpp"

namespace polar::cli {

namespace {
constexpr int kSomeFailed = 1;

struct Arguments {
  std::string config, output;
  std::vector<std::string> overrides;
  bool quiet = false, json_log = false;
  bool gather = false, no_tables = false, slurm = false, print = false;
  int jobs = 0;  // 0: not said
  BatchFlags flags;
  SlurmOptions slurm_options;
};

BatchFlags flags_of(const Arguments& a) {
  BatchFlags flags = a.flags;
  flags.command = command_line();
  if (a.jobs > 0) flags.jobs = a.jobs;
  if (a.gather) flags.part = BatchPart::tables;
  if (a.no_tables) flags.part = BatchPart::data_sets;
  return flags;
}

int run_here(const BatchConfig& config, const Arguments& a, Reporter& reporter) {
  const BatchOutcome outcome = run_batch(config, flags_of(a), reporter);
  if (outcome.cancelled) {
    reporter.note("stopped by signal " + std::to_string(received_signal()) +
                  ": the same command goes on from here");
    return 128 + received_signal();
  }
  for (const std::string& line : outcome.summary) std::printf("%s\n", line.c_str());
  return outcome.some_failed ? kSomeFailed : 0;
}

// What every task runs: this very program, with paths that hold in any folder.
std::vector<std::string> words_of_tasks(const BatchConfig& config, const Arguments& a) {
  std::vector<std::string> words = {std::filesystem::read_symlink("/proc/self/exe").string(), "batch",
                                    std::filesystem::absolute(a.config).string(), "--output",
                                    config.directory};
  for (const std::string& assignment : a.overrides) words.push_back("--set=" + assignment);
  if (a.flags.overwrite) words.emplace_back("--overwrite");
  if (a.quiet) words.emplace_back("--quiet");
  if (a.json_log) words.emplace_back("--json-log");
  return words;
}

int run_by_slurm(BatchConfig config, const Arguments& a, Reporter& reporter) {
  move_batch(config, std::filesystem::absolute(config.directory).string());
  SlurmOptions options = a.slurm_options;
  options.at_once = a.jobs;
  const SlurmBatch batch = slurm_batch(config, flags_of(a), options, words_of_tasks(config, a), reporter);
  if (a.print) {
    std::fputs(slurm_text(batch).c_str(), stdout);
    return 0;
  }
  if (batch.names.empty()) return run_here(config, a, reporter);  // only the tables are left to do
  for (const std::string& line : submit(batch)) std::printf("%s\n", line.c_str());
  return 0;
}

int run(const Arguments& a) {
  handle_signals();
  Reporter reporter(choose_style(a.quiet, a.json_log));
  BatchConfig config = load_batch_config(a.config, a.overrides);
  if (!a.output.empty()) move_batch(config, a.output);
  return a.slurm ? run_by_slurm(std::move(config), a, reporter) : run_here(config, a, reporter);
}

void add_slurm(CLI::App& sub, Arguments& a) {
  SlurmOptions& o = a.slurm_options;
  auto* slurm = sub.add_flag("--slurm", a.slurm,
                             "submit a Slurm array, a task a data set, and a job after it for the tables");
  const auto with_slurm = [&](CLI::Option* option) { option->needs(slurm); };
  with_slurm(sub.add_flag("--print", a.print, "with --slurm: print the script instead"));
  with_slurm(sub.add_option("--template", o.template_file,
                            "with --slurm: a script instead of configs/batch_slurm.sh"));
  with_slurm(sub.add_option("--partition", o.partition, "with --slurm: of the cluster"));
  with_slurm(sub.add_option("--time", o.time, "with --slurm: limit of a task, minutes or HH:MM:SS"));
  with_slurm(sub.add_option("--cpus", o.cpus, "with --slurm: threads of a task; 1 if not given")
                 ->check(CLI::Range(1, 4096)));
  with_slurm(sub.add_option("--memory", o.memory, "with --slurm: of a task, such as 16G"));
  with_slurm(sub.add_option("--sbatch", o.more,
                            "with --slurm: an option of sbatch without its dashes, such as account=imaging; "
                            "may be given several times"));
  with_slurm(sub.add_option("--notice", o.notice_s,
                            "with --slurm: seconds before its time limit at which a task leaves a checkpoint "
                            "and queues again; 120 if not given")
                 ->check(CLI::Range(1, 65535)));
  with_slurm(
      sub.add_option("--restarts", o.restarts, "with --slurm: times that a task may do so; 10 if not given")
          ->check(CLI::Range(0, 10000)));
}
}  // namespace

void add_batch(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("batch", "Run many data sets and compare their conditions");
  sub->add_option("config", a->config, "YAML configuration (configs/batch.yaml)")->required();
  sub->add_option("--only", a->flags.only, "name of a data set; may be given several times");
  sub->add_option("--jobs", a->jobs,
                  "data sets at a time: 1 if not given, with --slurm as many as the cluster grants")
      ->check(CLI::Range(1, 4096));
  sub->add_option("--threads", a->flags.threads, "of all jobs together; 0: all that the machine grants")
      ->check(CLI::Range(0, 4096));
  sub->add_option("--set", a->overrides, "section.key=value of every run, wins over the file");
  sub->add_option("--output", a->output, "directory, wins over output.directory");
  sub->add_flag("--overwrite", a->flags.overwrite, "replace results of another input or configuration");
  sub->add_flag("--quiet", a->quiet, "no progress, no warnings");
  sub->add_flag("--json-log", a->json_log, "progress and warnings as JSON lines on stderr");
  auto* no_tables = sub->add_flag("--no-tables", a->no_tables,
                                  "run the data sets and leave the tables over all to --gather");
  sub->add_flag("--gather", a->gather,
                "run nothing: make the tables of what --no-tables ran, here or on other machines")
      ->excludes(no_tables);
  add_slurm(*sub, *a);
  for (const char* name : {"--no-tables", "--gather", "--threads"})
    sub->get_option("--slurm")->excludes(sub->get_option(name));
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
