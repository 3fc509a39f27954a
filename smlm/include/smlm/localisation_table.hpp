// A localisation table after reading: one row a localisation, nanometres, standard deviations turned
// into covariances, every other column kept as it came.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace smlm {

/// Symmetric 3 x 3 covariance, nm^2, order xx xy xz yy yz zz, camera frame.
using Covariance = std::array<float, 6>;

/// A column of the input that the engine does not use but the output keeps.
struct ExtraColumn {
  std::string name;                 // as in the file
  std::string unit;                 // as in the file, empty when it says nothing
  std::vector<double> values;       // one a kept row; NaN where the file had nothing
  std::vector<std::string> labels;  // of a column of text: values are indices into it
};

/// Rows that were left out, counted by reason.
struct Rejection {
  std::string reason;
  std::uint64_t rows = 0;
  std::uint32_t file = 0;       // index into the table's files
  std::uint64_t first_row = 0;  // 1-based data row in the source, so that a user can look it up
};

struct LocalisationTable {
  std::vector<std::array<double, 3>> position_nm;  // z = 0 in planar tables
  std::vector<Covariance> covariance_nm2;   // positive definite; zz of a planar table is not registered with
  std::vector<std::int64_t> particle;       // index into particle_names; -1 where unassigned
  std::vector<std::string> particle_names;  // in order of first appearance
  std::vector<std::uint32_t> source_file;   // index into files
  std::vector<std::uint64_t> source_row;    // 1-based data row in that file
  std::vector<std::string> files;
  std::vector<std::string> formats;  // the reader of each file
  std::vector<ExtraColumn> extra;
  std::vector<Rejection> rejected;
  std::vector<std::string> mapping;  // one line a used column: "x <- 'x [nm]' (nm)"
  /// What the rows of no particle said instead, and how often: "-1", "", "nan".
  std::vector<std::pair<std::string, std::uint64_t>> unassigned;
  /// Keys of the input section that had a say in how the table was read.
  std::set<std::string> keys_used;
  std::vector<std::string> warnings;  // one line each, for the log and the report
  bool planar = false;                // no z, or one that says nothing: registered in the plane
  bool maybe_planar = false;          // z is constant, over too few rows to tell
  double position_unit_nm = 1;        // what x was given in
  bool axial_sigma_assumed = false;   // sigma_z was absent: 2 x lateral
  bool sigma_assumed = false;         // no uncertainty at all in the file

  std::size_t size() const { return position_nm.size(); }
};

}  // namespace smlm
