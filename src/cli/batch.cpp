#include "polar/pipeline/batch.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "reporter.hpp"
#include "signals.hpp"

namespace polar::cli {

namespace {
constexpr int kSomeFailed = 1;

struct Arguments {
  std::string config, output;
  std::vector<std::string> overrides;
  bool quiet = false, json_log = false;
  BatchFlags flags;
};

int run(const Arguments& a) {
  handle_signals();
  Reporter reporter(choose_style(a.quiet, a.json_log));
  BatchConfig config = load_batch_config(a.config, a.overrides);
  if (!a.output.empty()) move_batch(config, a.output);
  BatchFlags flags = a.flags;
  flags.command = command_line();
  const BatchOutcome outcome = run_batch(config, flags, reporter);
  if (outcome.cancelled) {
    reporter.note("stopped by signal " + std::to_string(received_signal()) +
                  ": the same command goes on from here");
    return 128 + received_signal();
  }
  for (const std::string& line : outcome.summary) std::printf("%s\n", line.c_str());
  return outcome.some_failed ? kSomeFailed : 0;
}
}  // namespace

void add_batch(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("batch", "Run many data sets and compare their conditions");
  sub->add_option("config", a->config, "YAML configuration (configs/batch.yaml)")->required();
  sub->add_option("--only", a->flags.only, "name of a data set; may be given several times");
  sub->add_option("--jobs", a->flags.jobs, "data sets at a time")->check(CLI::Range(1, 4096));
  sub->add_option("--threads", a->flags.threads, "of all jobs together; 0: all that the machine grants")
      ->check(CLI::Range(0, 4096));
  sub->add_option("--set", a->overrides, "section.key=value of every run, wins over the file");
  sub->add_option("--output", a->output, "directory, wins over output.directory");
  sub->add_flag("--overwrite", a->flags.overwrite, "replace results of another input or configuration");
  sub->add_flag("--quiet", a->quiet, "no progress, no warnings");
  sub->add_flag("--json-log", a->json_log, "progress and warnings as JSON lines on stderr");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
