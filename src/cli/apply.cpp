#include "polar/pipeline/apply.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "polar/pipeline/outputs.hpp"
#include "polar/pipeline/run_config.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::vector<std::string> overrides;
  ApplyOptions options;
};

int run(const Arguments& a) {
  ApplyOptions options = a.options;
  options.read = read_options(a.overrides);
  for (const std::string& line : apply_poses(options)) std::printf("%s\n", line.c_str());
  return 0;
}
}  // namespace

void add_apply(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub =
      app.add_subcommand("apply", "Move other tables of the same particles by poses that were found");
  sub->add_option("result", a->options.result, "result directory or poses.csv")->required();
  sub->add_option("tables", a->options.tables, "localisation tables with the particles' names")->required();
  sub->add_option("--output", a->options.directory, "directory to write into")->required();
  sub->add_option("--to,--format", a->options.formats, "one or more formats")
      ->delimiter(',')
      ->check(CLI::IsMember(table_formats()));
  sub->add_option("--set", a->overrides, "input.key=value: how the tables are read");
  sub->add_option("--voxel-nm", a->options.voxel_nm,
                  "voxel of rendered files; 0: half the median uncertainty")
      ->check(CLI::NonNegativeNumber);
  sub->add_flag("--overwrite", a->options.overwrite, "replace what is there");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
