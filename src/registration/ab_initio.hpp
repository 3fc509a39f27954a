// A template from nothing: poses drawn from their tempered posterior over a rotation grid that is turned at
// random in every sweep, the template refitted to the drawn poses, width and temperature annealed. The idea
// is cryo-EM's stochastic ab-initio search (A. Punjani et al., cryoSPARC, Nature Methods 14, 2017), here on
// point likelihoods.
#pragma once

#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar/fusion/pose_search.hpp"
#include "problem.hpp"

namespace polar {

/// What takes part in the starts: a few views, a few localisations of each.
struct StartContext {
  const Problem& problem;
  std::vector<int> which;  // views
  Subsets fitted;          // per view of the problem
  Subsets held_out;
};
StartContext start_context(const Problem& problem);
/// Of the quarter of the views (32 to 64) that show most of the structure (fullness.hpp), fullest first.
StartContext fullest_context(const Problem& problem);

struct AnnealingOptions {
  int sweeps = 30;
  int centres = 160;
  double first_width = 0.30, last_width = 0.10;  // of the template, in particle radii
  double first_beta = 0.05, last_beta = 1.0;     // inverse temperature of the pose posterior
  int rotations = 600;
  float shift = 0.12f;    // of the translations tried, along the axes
  float reach = 0;        // where it is larger: of a lattice of shifts
  int maximisations = 2;  // EM steps a sweep
};

/// A template and poses (template_from_view, one for each of context.which) under competition.
struct Hypothesis {
  std::string name;
  int number = 0;         // keys its random streams
  bool crowded = false;   // expects strands: many outliers at first, weak centres are sown anew
  bool one_view = false;  // began with one view: searched and narrowed in its own way (rounds.hpp)
  Mixture mixture;
  std::vector<Pose> pose;
  double held_out = 0;  // mean log density per localisation that was not fitted
};

/// A template of `centres` scattered over the localisations under the poses of `h`.
Hypothesis with_template(const StartContext& context, int centres, Hypothesis h);

/// First poses and a template scattered over the localisations under them.
Hypothesis random_start(const StartContext& context, int centres, int number, bool crowded);
Hypothesis imaged_start(const StartContext& context, int centres, int number);
/// The template is view context.which[rank]; poses are still to be found.
Hypothesis one_view_start(const StartContext& context, int centres, int number, int rank);

/// Anneals a hypothesis in place. `keep_first_poses`: the first sweep fits the template to the poses given.
void anneal(const StartContext& context, const AnnealingOptions& options, bool keep_first_poses,
            Hypothesis& h);

}  // namespace polar
