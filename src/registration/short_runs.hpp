// The first stage of the competition: a short run of every start, on a few localisations of a few views.
#pragma once

#include <optional>
#include <vector>

#include "ab_initio.hpp"
#include "polar/core/progress.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/registration/checkpoint.hpp"
#include "polar/registration/register.hpp"
#include "rounds.hpp"

namespace polar {

class ShortRuns {
 public:
  /// `model`: of the start `polar`, null where it is not wanted.
  ShortRuns(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options);

  /// The random starts come first, then those that begin with poses from elsewhere, `polar` and `imaged`,
  /// then, in the plane, those that begin with one of the fullest views.
  int few_random() const;
  int random() const { return random_; }
  int all() const { return all_; }

  /// Runs starts until `out` holds `count` of them; fewer when cancelled. What the checkpoint holds is not
  /// run again.
  void run_until(int count, Progress& progress, Checkpoint& checkpoint, std::vector<Hypothesis>& out) const;

  /// A start from poses of all views (template_from_view) that are meant to be near; expects no strands.
  Hypothesis from(const std::vector<Pose>& pose) const;

  /// What a hypothesis says of all views; identity for those that took no part.
  RoundState state_of(const Hypothesis& h) const;

 private:
  Hypothesis run(int number) const;
  Hypothesis one_view(int number) const;
  void settle(Hypothesis& h) const;

  StartContext thinned_, plain_;
  std::optional<StartContext> fullest_;  // in the plane
  const Autoencoder* model_;
  const RegistrationOptions& options_;
  int random_, posed_, all_;
};

}  // namespace polar
