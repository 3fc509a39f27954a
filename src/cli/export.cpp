#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "polar/pipeline/outputs.hpp"
#include "polar/results/registering_rows.hpp"
#include "polar/results/result_file.hpp"
#include "record_path.hpp"
#include "smlm/error.hpp"
#include "smlm/isolation.hpp"

namespace polar::cli {

namespace {
struct Arguments {
  std::string result, output;
  std::vector<std::string> formats;
  double voxel_nm = 0;
};

int run(const Arguments& a) {
  const std::string record = record_path(a.result);
  const std::filesystem::path beside = std::filesystem::path(record).parent_path();
  const std::string output = !a.output.empty() ? a.output : beside.empty() ? "." : beside.string();
  std::error_code unseen;  // what cannot be seen is no directory to write to
  if (!std::filesystem::is_directory(output, unseen))
    throw smlm::Error(smlm::Fault::io, output, "no such directory", "create it first");
  ResultRecord result = smlm::read_isolated(record, [&] { return read_result_file(record); });
  result.render.voxel_nm = a.voxel_nm;
  // Labels of the channels that are carried along have no place in the template.
  DiscreteSites sites;
  const bool some = !result.render.channel_column.empty() &&
                    std::find(a.formats.begin(), a.formats.end(), "sites") != a.formats.end();
  if (some)
    sites = find_sites(registering_rows(result.superparticle,
                                        {result.render.channel_column, false, result.registering_channels}),
                       result.render);
  std::vector<std::string> notes = result.warnings;  // what was assumed holds for every format
  for (const std::string& format : a.formats)
    for (const std::string& name :
         write_format(format, output,
                      {result.superparticle, result.render, result.poses, some ? &sites : nullptr}, notes))
      std::printf("%s/%s\n", output.c_str(), name.c_str());
  for (const std::string& note : notes) std::fprintf(stderr, "warning: %s\n", note.c_str());
  return 0;
}
}  // namespace

void add_export(CLI::App& app, Action& action) {
  auto a = std::make_shared<Arguments>();
  CLI::App* sub = app.add_subcommand("export", "Write further formats from a result's record");
  sub->add_option("result", a->result, "result directory or results.h5")->required();
  sub->add_option("--to,--format", a->formats, "one or more formats")
      ->required()
      ->delimiter(',')
      ->check(CLI::IsMember(export_formats()));
  sub->add_option("--output", a->output, "directory; default: beside the record");
  sub->add_option("--voxel-nm", a->voxel_nm, "voxel of rendered files; 0: half the median uncertainty")
      ->check(CLI::NonNegativeNumber);
  sub->callback([a, &action] { action = [a] { return run(*a); }; });
}

}  // namespace polar::cli
