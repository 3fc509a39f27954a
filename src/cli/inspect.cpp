#include "smlm/inspect.hpp"

#include <cstdio>
#include <memory>

#include "command.hpp"
#include "polar/pipeline/run_config.hpp"
#include "smlm/table_reader.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::vector<std::string> files, overrides;
  bool json = false;
};

bool is_configuration(const std::string& file) {
  const auto ends_with = [&](const std::string& end) {
    return file.size() > end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
  };
  return ends_with(".yaml") || ends_with(".yml");
}

// "cells/*.csv: 3 files", and what a user of another system may have expected of it.
std::string line_of(const MatchedPattern& p) {
  std::string line = p.pattern + ": " + std::to_string(p.files) + (p.files == 1 ? " file" : " files");
  if (p.but_for_case.empty()) return line;
  return line + " (not " + p.but_for_case.front() +
         (p.but_for_case.size() > 1 ? " and " + std::to_string(p.but_for_case.size() - 1) + " more" : "") +
         ", whose names differ in upper and lower case)";
}

int run(const Arguments& a) {
  std::vector<std::string> files = a.files;
  smlm::ReadOptions read;
  std::vector<MatchedPattern> patterns;
  if (files.size() == 1 && is_configuration(files[0])) {
    const RunConfig config = load_run_config(files[0], a.overrides);
    files = config.files;
    read = config.read;
    patterns = config.patterns;
  } else {
    read = read_options(a.overrides);
  }
  if (!a.json) {
    for (const MatchedPattern& p : patterns) std::printf("%s\n", line_of(p).c_str());
    std::fflush(stdout);
  }
  const smlm::Inspection inspection = smlm::inspect(smlm::read_tables(files, read));
  std::printf("%s\n", (a.json ? smlm::to_json(inspection) : smlm::to_text(inspection)).c_str());
  return 0;
}
}  // namespace

void add_inspect(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub =
      app.add_subcommand("inspect", "Show how tables are read: columns, units, particles, uncertainties");
  sub->add_option("files", a->files,
                  "tables, or one run configuration whose input section says how to read them")
      ->required();
  sub->add_option("--set", a->overrides, "input.key=value, wins over the configuration");
  const auto short_for = [a](const std::string& key) {
    return [a, key](const std::string& value) { a->overrides.push_back(key + "=" + value); };
  };
  sub->add_option_function<std::string>("--format", short_for("input.format"), "reader; default: by content");
  sub->add_option_function<std::string>("--pixel-size-nm", short_for("input.pixel_size_nm"),
                                        "camera pixel, nm");
  sub->add_flag_callback(
      "--one-per-file", [a] { a->overrides.emplace_back("input.particles=one_per_file"); },
      "every file is a particle");
  sub->add_flag("--json", a->json, "print JSON");
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
