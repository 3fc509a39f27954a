// How particles differ: the few displacements that the sites of all particles share, each particle's own
// share of them, and what of that is more than noise (docs/modes.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "polar/fitting/fit_data.hpp"

namespace polar::fitting {

struct ModesOptions {
  std::uint64_t seed = 1;
  int modes = 4;            // that are looked for
  int draws = 19;           // of sets without a further mode: 1 in 20 finds one by chance
  double pose_std_deg = 5;  // of the poses' errors, generous: such a motion is no mode
  double pose_std_nm = 5;
  double burst_distance = 3.4;  // Mahalanobis: see FitOptions
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const ModesOptions& options);

/// One mode: a particle with score a has its sites at mean + a * field (occupancies likewise).
struct Mode {
  Eigen::MatrixXd field;   // 3 x K nm (positions) or 1 x K (occupancies) at one standard deviation
  double variance = 0;     // mean square of the field: nm^2, or squared occupancy
  double control = 0;      // the largest that chance made of all draws (see docs/modes.md)
  double share = 0;        // of the variance above control in all modes
  double reliability = 0;  // correlation of scores with true ones that the noise allows
  double gain = 0,
         gain_std = 0;  // held-out evidence over the model without it (positions), nat a localisation
  double radial = 0, axial = 0;  // shares of the field that change the distance from z, and the height alone
  Eigen::VectorXd score, score_std;  // one a particle, in standard deviations; NaN: it shows no site

  bool above_noise =
      false;  // larger than control; of positions only where evidence does not speak against it
};

struct ModesReport {
  Eigen::Matrix3Xd site_nm;   // mean positions
  Eigen::VectorXd occupancy;  // share of the particles with a label there
  double width_nm = 0;        // standard deviation of labels about their displaced sites
  double background = 0;      // share of localisations
  std::vector<Mode> position, occupancy_mode;
};

/// Sites (3 x K, frame of the data) need not be exact: their means are fitted.
ModesReport find_modes(const std::vector<FitData>& particles, const Eigen::Matrix3Xd& site_nm,
                       const ModesOptions& options);

/// Places for a structure whose sites cannot be told apart: the means of `count` clusters of localisations.
Eigen::Matrix3Xd landmarks(const FitData& superparticle, int count, std::uint64_t seed);

}  // namespace polar::fitting
