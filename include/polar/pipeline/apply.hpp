// `polar apply`: other tables with the same particles, moved by poses that a run found.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"
#include "smlm/read_options.hpp"

namespace polar {

struct ApplyOptions {
  std::string result;               // result directory or poses.csv
  std::vector<std::string> tables;  // a second colour, a version with another drift correction, ...
  smlm::ReadOptions read;           // of these tables
  std::string directory;            // to write into
  std::vector<std::string> formats = {"csv"};  // of table_formats()
  double voxel_nm = 0;                         // of rendered files; 0: half the median uncertainty
  bool overwrite = false;
};

/// Matches particles by name and writes their localisations in the template frame, as a run writes its
/// superparticle. Returns the lines to show the user. Throws smlm::Error (input) when no particle of the
/// tables has a pose.
std::vector<std::string> apply_poses(const ApplyOptions& options);

}  // namespace polar
