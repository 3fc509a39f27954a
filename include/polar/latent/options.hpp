// What the latent registration (the paper's POLAR) can be asked for. Lengths are in units of the autoencoder,
// in which a structure has a radius of about 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace polar {

struct LatentOptions {
  std::uint64_t seed = 1;                         // every random choice follows from it
  std::string search = "fast";                    // fast | exhaustive: how many rotations FLAMES looks at
  std::string optimizer = "levenberg_marquardt";  // levenberg_marquardt | adamw (the paper's)

  /// fused: the localisations of registered views are the template; decoded: D(z), the paper's, and what
  /// is always taken with adamw or where outliers are expected.
  std::string template_kind = "fused";
  /// nu_i: per_localisation (a draw from each localisation's own covariance) | common (from the view's mean
  /// covariance, the paper's) | none.
  std::string noise = "per_localisation";
  /// Draw as many template points as the view has localisations, because the maximum over points grows with
  /// their number; false: all decoded points against all localisations, as in the paper.
  bool matched_counts = true;
  int localisations = 384;      // of a view that take part at most
  double visibility = 1;        // share of the structure that a view shows; 0: estimated for each view
  double outlier_fraction = 0;  // share of a view that is not of the structure; -1: estimated for each view

  double regularisation = 1e-2;        // lambda of the even density R(z), for 100 views
  double regularisation_radius = 0.1;  // of its balls
  int medoids = 0;         // first templates that compete; 0: one, or three where views are cropped
  int basins = 8;          // M: local minima that are refined for each view
  int rotations = 0;       // of FLAMES' grid; 0: as `search` says
  int most_loops = 6;      // of Algorithm 1
  double escape_deg = 15;  // T_R: a view that moved farther has escaped from a local minimum
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const LatentOptions& options);

}  // namespace polar
