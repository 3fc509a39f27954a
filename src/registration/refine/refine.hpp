// The exact end of the loop: a template of centres, every localisation with its own covariance. Search, fuse,
// climb, narrower each round as long as held-out localisations gain by it (paper Algorithm 1 with the
// likelihood in place of the latent loss).
#pragma once

#include <limits>
#include <vector>

#include "../data/evidence.hpp"
#include "../data/problem.hpp"
#include "polar/core/progress.hpp"
#include "polar/flames/search_grid.hpp"
#include "polar/fusion/maximisation.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

struct Fit {
  Mixture mixture;
  std::vector<Pose> pose;  // template_from_view, all views
  NoiseModel noise;
  RotationGroup group;                                         // of the template; empty: none
  std::vector<double> margin;                                  // of the last search
  double occupancy = std::numeric_limits<double>::infinity();  // strength (polar/fusion/occupancy.hpp)
  Evidence evidence;                                           // of all views, at this width and noise
  std::vector<RoundReport> history;
  int rounds = 0;
  int escaped = 0;  // views that moved far in the last search
};

/// Sets what of the template each view of `data` (all views) shows.
void show(const Fit& fit, const Mixture& mixture, FusionData& data);

class Refiner {
 public:
  Refiner(const Problem& problem, const SearchGrid& grid, const EngineOptions& options)
      : problem_(problem),
        grid_(grid),
        options_(options.refine),
        standard_errors_(options.evidence.standard_errors) {}

  /// A template under these poses, at the first width.
  Fit begin(std::vector<Pose> pose, const NoiseModel& noise, const RotationGroup& group) const;
  /// The same with its evidence.
  Fit judged(Fit fit) const {
    fit.evidence = judge(fit);
    return fit;
  }
  /// Rounds until nothing is gained; keeps the best.
  Fit rounds(Fit fit, Progress& progress) const;
  /// One more, at the width that was reached.
  Fit last_round(Fit fit) const;
  /// Narrower, without a search, as long as evidence gains.
  Fit narrowed(Fit fit) const;
  /// Stated uncertainties times what evidence asks for, the template fitted again under each proposal.
  Fit with_noise(Fit fit) const;
  /// Noise and template in turn, as long as evidence gains.
  Fit calibrated(Fit fit) const;
  /// Fewer centres, as long as evidence does not lose by it.
  Fit discrete(Fit fit) const;
  /// One search over all views; counts those that moved far.
  void search(Fit& fit) const;
  /// Template and poses on all localisations.
  void sweep(Fit& fit, int sweeps) const;
  /// Of template and poses fitted again without the held-out localisations.
  Evidence judge(const Fit& fit) const { return held_out(blind(fit)); }
  /// The same with every pose searched for anew, so that nothing of the held-out localisations is left in it,
  /// and beside it under the cloud that is left of the template when it is turned any way about its centre:
  /// what an average explains that has no orientation.
  struct AgainstCloud {
    Evidence structure, cloud;
  };
  AgainstCloud judge_against_cloud(Fit fit) const;

 private:
  void judge_round(const std::vector<Pose>& before, bool searched, Fit& fit) const;
  void search(const Subsets& subsets, Fit& fit) const;
  void sweep(const Subsets& subsets, Fit& fit, int sweeps) const;
  Fit blind(Fit fit) const;
  Evidence held_out(const Fit& fit) const;

  const Problem& problem_;
  const SearchGrid& grid_;
  RefineOptions options_;
  double standard_errors_;  // within which nothing is told apart
};

}  // namespace polar
