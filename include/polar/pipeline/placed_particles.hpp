// What `polar fit` and `polar modes` work on: particles with their poses, of a record or of tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/results/result_file.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

struct PlacedInput {
  /// A result directory or results.h5, or localisation tables.
  std::vector<std::string> inputs;
  std::string poses;                   // poses.csv of the tables' particles; empty: they have none
  std::vector<std::string> overrides;  // input.key=value: how tables are read
};

struct PlacedParticles {
  /// In the template frame where poses are known, else as in the input; covariances calibrated.
  smlm::LocalisationTable table;
  bool placed = false;                 // poses are known
  std::optional<TemplateSites> sites;  // the template of a record
  RenderOptions render;                // that draws `table`: nothing is left to calibrate
  std::vector<std::string> warnings;
};

/// A folder of that name in a result, or beside the first table.
std::string folder_beside(const PlacedInput& input, const std::string& name);

/// Throws smlm::Error.
PlacedParticles read_placed_particles(const PlacedInput& input);

}  // namespace polar
