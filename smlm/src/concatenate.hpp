// Several files' tables into one.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"
#include "smlm/read_options.hpp"

namespace smlm {

class Concatenation {
 public:
  Concatenation(const std::vector<std::string>& files, const ReadOptions& options);

  /// Appends the table of the next file, in the order of `files`.
  void append(LocalisationTable table);
  /// Settles whether the whole is planar and words the warnings.
  LocalisationTable finish();

 private:
  void name_particles(LocalisationTable& table);
  void require_one_depth(const LocalisationTable& table);
  void warn_about_particles();
  void add_channel(LocalisationTable& table) const;
  void append_particles(LocalisationTable& table);
  void append_extra(const LocalisationTable& table, std::size_t rows_before);

  const std::vector<std::string>& files_;
  bool one_per_file_, by_column_;
  bool file_is_channel_;            // of the same particles
  std::vector<std::string> names_;  // of the files, as short as keeps them apart
  LocalisationTable all_;
  std::size_t appended_ = 0;
  std::string first_planar_, first_spatial_;  // files that decide whether the whole is planar
  bool maybe_planar_ = false;                 // some file has too few rows to tell
  std::vector<std::string> without_particle_column_, with_ignored_particle_column_;
  std::vector<std::string> warning_order_;
  std::map<std::string, std::vector<std::string>> warned_files_;
};

/// What files are called in the names of particles: the file name without its extensions, with them where two
/// in one folder are else alike, and with as many of the folders above as tell equal ones apart.
std::vector<std::string> short_names(const std::vector<std::string>& files);

}  // namespace smlm
