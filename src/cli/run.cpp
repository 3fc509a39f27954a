#include "polar/pipeline/run.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "polar/core/parallel.hpp"
#include "reporter.hpp"
#include "signals.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string config, output;
  std::vector<std::string> overrides;
  int threads = 0;
  bool quiet = false, json_log = false;
  RunFlags flags;
};

int run(const Arguments& a) {
  handle_signals();
  const ThreadLimit threads(a.threads);
  Reporter reporter(choose_style(a.quiet, a.json_log));
  RunConfig config = load_run_config(a.config, a.overrides);
  if (!a.output.empty()) config.output.directory = a.output;
  RunFlags flags = a.flags;
  flags.command = command_line();
  const RunOutcome outcome = polar::run(config, flags, reporter);
  if (outcome.cancelled) {
    reporter.note("stopped by signal " + std::to_string(received_signal()) + ": no result was written" +
                  (outcome.resumable ? "; --resume continues from the checkpoint" : ""));
    return 128 + received_signal();
  }
  for (const std::string& line : outcome.summary) std::printf("%s\n", line.c_str());
  return 0;
}
}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("run", "Align all particles and write the superparticle");
  sub->add_option("config", a->config, "YAML configuration (configs/default.yaml)")->required();
  sub->add_option("--set", a->overrides, "section.key=value, wins over the file");
  sub->add_option("--output", a->output, "directory, wins over output.directory");
  sub->add_option("--threads", a->threads,
                  "0: all that the machine grants; the result is the same for any number")
      ->check(CLI::Range(0, 4096));
  sub->add_flag("--quiet", a->quiet, "no progress, no warnings");
  sub->add_flag("--json-log", a->json_log, "progress and warnings as JSON lines on stderr");
  auto* overwrite = sub->add_flag("--overwrite", a->flags.overwrite, "replace an earlier result");
  sub->add_flag("--resume", a->flags.resume,
                "keep a complete result of the same computation, or continue one that was cut short")
      ->excludes(overwrite);
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
