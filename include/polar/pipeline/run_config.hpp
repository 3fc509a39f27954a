// The configuration of `polar run` (configs/default.yaml has every key) as option structs.
#pragma once

#include <string>
#include <vector>

#include "polar/registration/register.hpp"
#include "smlm/read_options.hpp"

namespace polar {

struct OutputOptions {
  std::string directory = "results";
  /// Beside poses.csv and summary.json, which are always written: hdf5 (results.h5, the record) and any of
  /// export_formats() (outputs.hpp).
  std::vector<std::string> formats = {"hdf5", "vtkhdf", "csv"};
  double voxel_nm = 0;  // of template.hdf and preview.png; 0: half the median uncertainty
  bool preview = true;  // preview.png
  bool report = true;   // report.html, the page to look at
  /// own: the template in the frame that its symmetry or its principal axes suggest | raw: as the engine left
  /// it.
  std::string frame = "own";
  /// Places for a label that are one site of the template, as far as it can be resolved: for the labelling
  /// efficiency.
  int labels_per_site = 1;
  /// none | halves: registers two halves of the particles independently as well, and two of pure noise, and
  /// reports their Fourier shell correlation (twice the time again).
  std::string resolution = "none";
};

/// A pattern among input.files.
struct MatchedPattern {
  std::string pattern;  // as written
  std::size_t files = 0;
  std::vector<std::string> but_for_case;  // files that would match if case did not matter
};

struct RunConfig {
  std::vector<std::string> files;  // absolute, expanded
  std::vector<MatchedPattern> patterns;
  smlm::ReadOptions read;
  RegistrationOptions registration;
  /// poses.csv with poses to start from (template_from_view), instead of registration.starts; empty: none are
  /// known.
  std::string initial_poses;
  /// Sites, or an earlier results.h5: the structure of the start `template`; empty: none is known.
  std::string template_file;
  OutputOptions output;
};

/// Reads the file, applies `section.key=value` overrides, resolves paths against the file's folder and checks
/// everything. Throws smlm::Error: usage for the configuration, input for files that do not exist.
RunConfig load_run_config(const std::string& path, const std::vector<std::string>& overrides);

/// How tables are read that are named without a configuration: the defaults with `input.key=value` overrides.
/// Throws smlm::Error (usage).
smlm::ReadOptions read_options(const std::vector<std::string>& overrides);

/// The effective configuration as YAML text, every key written; reads back to the same configuration.
std::string run_config_text(const RunConfig& config);

}  // namespace polar
