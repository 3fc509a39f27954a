// How right a set of poses is, once the motion of the whole template and the particle's own symmetry are
// taken out (the paper's section V, "Metrics").
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"

namespace polar {

struct CompareOptions {
  std::string symmetry = "none";                 // group of the structure, in the truth's frame
  std::vector<double> angles_deg = {5, 10, 15};  // thresholds of the recall
  std::uint64_t seed = 1;                        // of the pairs, where they are sampled
};

/// One particle after the best common motion G was removed.
struct ParticleError {
  std::string particle;
  bool compared = false;      // both tables hold a pose
  double rotation_deg = 180;  // min over g of angle(D, G g), D = estimate truth^-1
  double translation_nm = 0;  // distance of the structure's centre from where G puts it
};

struct Comparison {
  std::size_t n_truth = 0;     // particles with a true pose
  std::size_t n_compared = 0;  // of these, particles with an estimated pose
  std::uint64_t n_pairs = 0;   // pairs that the angles below were taken from
  bool sampled = false;        // true: too many pairs, a keyed sample of them

  /// Relative rotation error theta_ij = min over g of angle(D_i g, D_j), over pairs of compared particles.
  double median_pair_deg = 0;
  std::vector<double> angles_deg;
  std::vector<double> recall;           // share of compared pairs with theta_ij <= angle
  std::vector<double> recall_of_truth;  // the same over all pairs of n_truth: a missing pose is a wrong one
  std::vector<double> cdf;              // share with theta_ij <= 1, 2, ..., 180 degrees

  Pose global_motion;  // G: estimated template from true structure
  double median_rotation_deg = 0;
  double median_translation_nm = 0;  // over the n_aligned particles
  std::size_t n_aligned = 0;         // particles within kAlignedWithin_deg of G
  std::vector<ParticleError> particle;
  std::string note;  // how ids were matched, where they are not spelt alike; else empty
};

/// A particle farther from G than this does not take part in translation statistics.
constexpr double kAlignedWithin_deg = 30;

/// Matches particles by name; where fewer than two names occur in both tables, and all are numbers, by number
/// ("1.0" and "1"), which is noted. Throws smlm::Error (input) when fewer than two can be compared, or a name
/// occurs twice.
Comparison compare_poses(const std::vector<PoseRow>& estimate, const std::vector<PoseRow>& truth,
                         const CompareOptions& options);

}  // namespace polar
