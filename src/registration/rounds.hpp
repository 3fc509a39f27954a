// Search, fuse, refine, narrower each round, until no view moves (paper Algorithm 1 with the likelihood in
// place of the latent loss).
#pragma once

#include <limits>
#include <vector>

#include "polar/core/progress.hpp"
#include "polar/fusion/orbits.hpp"
#include "polar/fusion/pose_search.hpp"
#include "polar/registration/checkpoint.hpp"
#include "problem.hpp"

namespace polar {

struct RoundOptions {
  int rotations = 2304;  // of the search grid; exhaustive: 50,000
  int planar_rotations = 180;
  int basins = 8;  // M
  int search_localisations = 128;
  double first_width = 0.09, last_width = 0.03, narrowing = 0.72;
  double search_width = 0.05;  // the search looks at the template no sharper than this
  float shift = 0.10f, step = 0.06f;
  float stray_reach = 0.4f;  // of the shifts where a particle lacks so much that its centre is off
  double far_reach = 1.2, far_spacing = 0.2;  // of the shifts where the centre of a view may be far off
  int far_coarse = 32;                        // localisations looked at for every one of them
  int promising = 200;
  int sweeps = 4;  // of EM and pose steps after each search
  int most_searches = 4;
  double settled = 0.01;  // share of views that may still move when searching ends
};

struct RoundState {
  Mixture mixture;
  std::vector<Pose> pose;      // template_from_view, all views
  std::vector<double> margin;  // of the last search
  bool crowded = true;         // template_tools.hpp
  bool one_view = false;  // began with one: searches shift as far as centres stray, and the template, one
                          // of few sharp sites, is not scattered anew
  double occupancy =
      std::numeric_limits<double>::infinity();  // polar/fusion/occupancy.hpp: strength of its prior
  RotationGroup group;                          // of the template, where one is imposed (symmetry.hpp)
  bool sites = false;        // the template is one of discrete sites of equal weight (finish.hpp)
  double width = 0;          // of the template after the last round kept
  double held_out = -1e300;  // mean log density of the held-out localisations at that width
  int rounds = 0;
  int escaped = 0;             // in the last search
  int twins = 0;               // of these, in the last search of all, to where the template looks the same
  bool cut = false;            // views are cut by planes (polar/fusion/cuts.hpp)
  bool far = false;            // the next search shifts views far: they show parts of the structure
  bool structureless = false;  // held-out localisations are explained no better than by a cloud
};

/// Number of centres for so many localisations: enough for a surface, few enough to be determined.
int centres_for(const Problem& problem);

/// A template of the views `which` alone, fitted to their poses at the first round's width.
void fuse_anew(const Problem& problem, const RoundOptions& options, const std::vector<int>& which,
               RoundState& state);

/// One FLAMES over all views under the present template; looks at the first few of `subset` of each view.
/// Returns the views that escaped.
std::vector<std::size_t> search_all(const Problem& problem, const SearchGrid& grid,
                                    const RoundOptions& options, const NoiseModel& noise,
                                    const Subsets& subset, RoundState& state);

/// Once more for the tenth of the views that the template explains worst, with far shifts: what lies beside a
/// particle moves the centre that its view was given. Returns the views that escaped.
std::vector<std::size_t> search_misfits(const Problem& problem, const SearchGrid& grid,
                                        const RoundOptions& options, const NoiseModel& noise,
                                        RoundState& state);

/// From a template and poses of some views (identity for the others) to poses of all. Narrows as long as
/// held-out localisations gain by it: few localisations end with a wide template. False: cancelled between
/// two rounds; the next call with the same checkpoint goes on from there.
bool run_rounds(const Problem& problem, const SearchGrid& grid, const RoundOptions& options,
                Progress& progress, Checkpoint& checkpoint, RoundState& state);

}  // namespace polar
