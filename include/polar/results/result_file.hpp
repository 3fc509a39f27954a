// results.h5: the record of a run in one self-describing HDF5 file (layout in docs/formats.md).
#pragma once

#include <string>

#include "polar/results/render.hpp"
#include "polar/results/results.hpp"

namespace polar {

/// What `polar export` and a resumed run need of the record.
struct ResultRecord {
  smlm::LocalisationTable superparticle;
  TemplateSites sites;
  std::vector<PoseRow> poses;                     // without their standard deviations
  RenderOptions render;                           // its calibration
  std::vector<std::string> registering_channels;  // see Results; of render.channel_column
  std::string program, configuration, input_hash;
  std::vector<std::string> warnings;  // of the run: what it assumed
};

/// Writes the record whole or not at all.
void write_result_file(const std::string& path, const Results& results,
                       const smlm::LocalisationTable& superparticle);

/// Whether a file is a record, and not a localisation table.
bool is_result_file(const std::string& path);

/// Reads a record. Throws smlm::Error (input) for a file that is none, or of a later format.
ResultRecord read_result_file(const std::string& path);

}  // namespace polar
