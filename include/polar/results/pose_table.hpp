// poses.csv: one line a particle. The same table holds what a run found and what a simulation knows.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"

namespace polar {

/// One line. Lengths in nm; the numbers of a particle without a pose are NaN and written empty.
struct PoseRow {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  std::string particle;
  std::uint64_t n_localisations = 0;
  std::uint64_t n_used = 0;
  bool accepted = false;
  std::string reason;                      // why not accepted
  std::optional<Pose> template_from_view;  // x_template = R x_view + t, table coordinates in nm
  double rotation_std_deg = kNone;         // root mean square angle of the rotation's error
  double translation_std_nm = kNone;       // root mean square length of the translation's error
  double log_likelihood = kNone;           // mean per localisation
  double margin = kNone;                   // log_likelihood above the second-best pose found
};

/// The file's text; numbers with the shortest digits that read back to the same double, in any locale.
std::string format_pose_table(const std::vector<PoseRow>& rows);

/// Reads a poses.csv (columns by name; those of the pose and `particle` must be there). Throws smlm::Error
/// (input) with file and line.
std::vector<PoseRow> read_pose_table(const std::string& path);

}  // namespace polar
