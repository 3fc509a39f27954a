// A molecule that stays on for several frames is localised once in each: its localisations become one.
#pragma once

#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

struct BlinkOptions {
  /// Between localisations of one molecule at most: "20 nm" (laterally), or "2 sigma" of both localisations'
  /// uncertainties together, laterally and along z; empty: nothing is merged.
  std::string distance;
  int dark_frames = 1;  // that a molecule may be off in between
};

/// One sentence per fault, each starting with its key; empty when the options can be used.
std::vector<std::string> violations(const BlinkOptions& options);

/// Chains localisations of the same particle (or of none): from each one to the first that follows it, in the
/// order of frames and of rows within a frame, at most dark_frames + 1 frames later and near enough, that no
/// earlier chain has taken. A chain becomes one localisation: mean weighted by the inverse covariances, their
/// sum's inverse as covariance; photons and background are summed, the frame, the row and texts are the
/// first's, other columns are averaged; `merged` is a new column with their number. Rows are then in the
/// order of frames. Throws Error(input) where the table has no frames.
void merge_blinks(LocalisationTable& table, const BlinkOptions& options);

}  // namespace smlm
