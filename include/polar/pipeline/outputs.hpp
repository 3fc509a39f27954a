// The files of a result directory, and which of them a format stands for.
#pragma once

#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"
#include "polar/results/render.hpp"
#include "polar/results/sites.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// What files are made of.
struct ExportInput {
  const smlm::LocalisationTable& superparticle;
  const RenderOptions& render;
  std::vector<PoseRow> poses = {};       // of every particle; empty: they are not known
  const DiscreteSites* sites = nullptr;  // null: not looked for yet
};

/// A format that can be made by a run or later by `polar export`.
struct OutputFormat {
  std::string name;                // in output.formats and of `polar export --to`
  std::vector<std::string> files;  // that it writes
  /// Into a folder that ends in a slash.
  void (*write)(const std::string& folder, const ExportInput& input, std::vector<std::string>& notes);
  bool needs_poses = false;  // else the superparticle is enough
};

const std::vector<OutputFormat>& output_formats();

/// Their names.
std::vector<std::string> export_formats();

/// Those that a table without poses is enough for.
std::vector<std::string> table_formats();

/// Density of each of two halves of the particles, which a run with `mrc` and `resolution: halves` writes.
const std::vector<std::string>& half_map_files();
/// The page, and what it is called after: the folder of a result.
constexpr const char* kReportFile = "report.html";
std::string report_name(const std::string& directory);

/// Every name in a result directory that a run may have written.
std::vector<std::string> result_files();

/// Writes the files of one of export_formats() into `directory`; returns their names, and adds to `notes`
/// what the format could not take as it is. Throws smlm::Error.
std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const ExportInput& input, std::vector<std::string>& notes);

}  // namespace polar
