#include <cstdio>
#include <memory>

#include "command.hpp"
#include "polar/pipeline/simulate_run.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string config;
  std::vector<std::string> overrides;
  std::string output;
  bool overwrite = false;
};

int run(const Arguments& a) {
  SimulateConfig config = load_simulate_config(a.config, a.overrides);
  if (!a.output.empty()) config.directory = a.output;
  for (const std::string& line : run_simulation(config, a.overwrite)) std::printf("%s\n", line.c_str());
  return 0;
}
}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("simulate", "Simulate a localisation table with known poses");
  sub->add_option("config", a->config, "YAML configuration (configs/simulate.yaml)")->required();
  sub->add_option("--set", a->overrides, "section.key=value, wins over the file");
  sub->add_option("--output", a->output, "directory, wins over output.directory");
  sub->add_flag("--overwrite", a->overwrite, "replace an earlier simulation");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
