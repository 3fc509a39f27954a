#include <cstdio>
#include <memory>

#include "command.hpp"
#include "command_line.hpp"
#include "measuring.hpp"
#include "polar/pipeline/fit_run.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  FitRunOptions options;
  std::string pose = "free";
  Manner manner;
  bool no_evidence = false;
};

int run(const Arguments& a) {
  const ThreadLimit threads(a.manner.threads);
  Reporter reporter(a.manner.style());
  FitRunOptions options = a.options;
  options.fit.free_pose = a.pose == "free";
  options.evidence = !a.no_evidence;
  options.command = command_line();
  for (const std::string& line : run_fit(options, reporter)) std::printf("%s\n", line.c_str());
  return 0;
}
}  // namespace

void add_fit(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  FitRunOptions& o = a->options;
  std::string models;
  for (const std::string& name : fit_models()) models += (models.empty() ? "" : ", ") + name;
  CLI::App* sub =
      app.add_subcommand("fit", "Measure a geometric model on a result or on tables, with errors");
  add_input_options(*sub, o.input);
  sub->add_option("--model", o.model, models + ", or a model file")->required();
  sub->add_option("--sites", o.sites, "table of x, y, z: the sites of the model `sites`");
  sub->add_option("--hold", o.hold, "name or name=value: holds a parameter at its start or at the value");
  sub->add_option("--output", o.directory, "directory; default: fit_<model> beside the input");
  sub->add_option("--pose", a->pose, "of a particle that has one: free (under a prior) or fixed")
      ->check(CLI::IsMember({"free", "fixed"}));
  sub->add_option("--pose-std-deg", o.fit.pose_std_deg, "standard deviation of that prior, degrees");
  sub->add_option("--pose-std-nm", o.fit.pose_std_nm, "and of its shift, nm");
  sub->add_option("--starts", o.fit.starts, "orientations to start from where the placement is not known");
  sub->add_option("--burst-distance", o.fit.burst_distance,
                  "Mahalanobis: nearer localisations may be of one label, and are not independent");
  sub->add_flag("--no-evidence", a->no_evidence, "do not hold the model against the free template");
  add_manner_options(*sub, a->manner, o.fit.seed, o.overwrite);
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
