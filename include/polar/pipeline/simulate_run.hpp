// `polar simulate`: one YAML file becomes a localisation table, its true poses and the structure's sites.
#pragma once

#include <string>
#include <vector>

#include "polar/simulation/simulate.hpp"
#include "polar/simulation/structure_file.hpp"

namespace polar {

/// What a simulation configuration holds (configs/simulate.yaml has every key).
struct SimulateConfig {
  StructureOptions structure;  // structure.kind `file` reads `file` instead
  StructureFile file;
  SimulationOptions simulation;
  std::string directory = "simulated";
  std::string format = "csv";  // csv | picasso
};

/// Reads the file, applies `section.key=value` overrides, resolves paths against the file's folder and checks
/// everything. Throws smlm::Error (usage).
SimulateConfig load_simulate_config(const std::string& path, const std::vector<std::string>& overrides);

/// The same configuration as YAML text, every key written.
std::string simulate_config_text(const SimulateConfig& config);

/// Writes localisations.csv (or .hdf5), poses.csv (the truth), sites.csv, truth.json and simulation.yaml
/// into the directory; files that are there need `overwrite`. Returns the lines to show the user.
std::vector<std::string> run_simulation(const SimulateConfig& config, bool overwrite);

/// What truth.json beside a true poses.csv says.
struct TruthSummary {
  std::string structure;
  std::string symmetry = "none";
  double cramer_rao_pair_median_deg = 0;  // NaN where it was not computed
};

/// Reads the truth.json beside `poses_csv`; false where there is none.
bool read_truth_summary(const std::string& poses_csv, TruthSummary& summary);

}  // namespace polar
