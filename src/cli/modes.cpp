#include <cstdio>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "measuring.hpp"
#include "polar/pipeline/modes_run.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  ModesRunOptions options;
  Manner manner;
};

int run(const Arguments& a) {
  const ThreadLimit threads(a.manner.threads);
  Reporter reporter(a.manner.style());
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
  add_input_options(*sub, o.input);
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
  sub->add_option("--output", o.directory, "directory; default: modes beside the input");
  add_manner_options(*sub, a->manner, o.modes.seed, o.overwrite);
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
