// The files of a result directory, and which of them a format stands for.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// A format that can be made from the superparticle alone, by a run or later by `polar export`.
struct OutputFormat {
  std::string name;                // in output.formats and of `polar export --to`
  std::vector<std::string> files;  // that it writes
  void (*write)(const std::string& folder, const smlm::LocalisationTable& superparticle,
                const RenderOptions& render, std::vector<std::string>& notes);  // folder ends in a slash
};

const std::vector<OutputFormat>& output_formats();

/// Their names.
std::vector<std::string> export_formats();

/// The page, and what it is called after: the folder of a result.
constexpr const char* kReportFile = "report.html";
std::string report_name(const std::string& directory);

/// Every name in a result directory that a run may have written.
std::vector<std::string> result_files();

/// Writes the files of one of export_formats() into `directory`; returns their names, and adds to `notes`
/// what the format could not take as it is. Throws smlm::Error.
std::vector<std::string> write_format(const std::string& format, const std::string& directory,
                                      const smlm::LocalisationTable& superparticle,
                                      const RenderOptions& render, std::vector<std::string>& notes);

}  // namespace polar
