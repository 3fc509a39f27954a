// Looks for a better pose of every view under a fixed template: FLAMES on the blurred volumes, then the best
// basins refined on the exact mixture. The paper's multistart with its update u and escape test s (eq. 14,
// 15).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar/fusion/orbits.hpp"
#include "polar/fusion/pose_search.hpp"

namespace polar {

struct SearchAgainOptions {
  int basins = 8;  // M of the paper
  // Log likelihood by which a mode may lie below the best by look-ups, which err, and still be refined.
  double lookup_doubt = 14;
  double climb_shift = 0.03;     // first step of a mode's ascent by look-ups, particle radii
  double climb_turn = 0.3;       // the same of turns, of the grid's spacing: half of it may leave the basin
  double same_mode_rad = 0.1;    // within which two climbed poses are one
  int evaluations = 8;           // of the refinement of a mode
  int most_localisations = 160;  // of a view that the search looks at: enough to find basins
  // Basins whose log likelihoods differ by less over so few localisations are told apart by more of them.
  double doubt = 8;
  int most_judging = 1000;
  int judging_evaluations = 16;
  int sigma_classes = 3;
  double escape_rad = 0.2617993877991494;  // T_R = 15 degrees
  double escape_gain = 2;  // log likelihood that a move must gain to count: less is a symmetric twin or a tie
  RotationGroup group;     // of the template: poses that differ by an element are one
  SearchOptions grid;
};

struct SearchAgainReport {
  std::vector<std::size_t> escaped;  // views that moved farther than T_R to a better likelihood
  std::vector<double> margin;  // per view: best minus second-best basin, mean log density per localisation
};

/// Poses are template_from_view of all views, improved in place. `subset`: localisations of each view that
/// the search looks at, in an order whose first ones are a fair sample.
SearchAgainReport search_again(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                               const Subsets& subset, const Mixture& mixture, const NoiseModel& noise,
                               const SearchGrid& grid, const Eigen::Matrix3f& turn,
                               const SearchAgainOptions& options, std::vector<Pose>& template_from_view);

}  // namespace polar
