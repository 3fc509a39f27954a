#include <cstdio>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "polar/core/parallel.hpp"
#include "polar/pipeline/modes_run.hpp"
#include "reporter.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  ModesRunOptions options;
  int threads = 0;
  bool quiet = false, json_log = false;
};

int run(const Arguments& a) {
  const ThreadLimit threads(a.threads);
  Reporter reporter(choose_style(a.quiet, a.json_log));
  ModesRunOptions options = a.options;
  options.command = command_line();
  for (const std::string& line : run_modes(options, reporter)) std::printf("%s\n", line.c_str());
  return 0;
}
}  // namespace

void add_modes(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  ModesRunOptions& o = a->options;
  CLI::App* sub = app.add_subcommand("modes", "Find how the particles of a result differ from their average");
  sub->add_option("input", o.input.inputs,
                  "result directory, results.h5, or localisation tables with --poses")
      ->required();
  sub->add_option("--sites", o.sites,
                  "table of x, y, z in the template frame; default: as found, else landmarks");
  sub->add_option("--landmarks", o.landmarks, "places that stand for sites which cannot be told apart")
      ->check(CLI::Range(3, 1000));
  sub->add_option("--modes", o.modes.modes, "modes that are looked for");
  sub->add_option("--draws", o.modes.draws, "mirrored sets of the noise control");
  sub->add_option("--pose-std-deg", o.modes.pose_std_deg,
                  "errors of poses, generous: such a motion is no mode");
  sub->add_option("--pose-std-nm", o.modes.pose_std_nm, "and of their shifts, nm");
  sub->add_option("--burst-distance", o.modes.burst_distance,
                  "Mahalanobis: nearer localisations may be of one label, and judge together");
  sub->add_option("--poses", o.input.poses, "poses.csv of the tables' particles");
  sub->add_option("--set", o.input.overrides, "input.key=value: how tables are read");
  sub->add_option("--output", o.directory, "directory; default: modes beside the input");
  sub->add_option("--seed", o.modes.seed, "every random choice follows from it");
  sub->add_option("--threads", a->threads,
                  "0: all that the machine grants; the result is the same for any number")
      ->check(CLI::Range(0, 4096));
  sub->add_flag("--quiet", a->quiet, "no progress, no warnings");
  sub->add_flag("--json-log", a->json_log, "progress and warnings as JSON lines on stderr");
  sub->add_flag("--overwrite", o.overwrite, "replace what is there");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
