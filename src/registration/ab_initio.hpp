// A template from nothing: poses drawn from their tempered posterior over a rotation grid that is turned at
// random in every sweep, the template refitted to the drawn poses, width and temperature annealed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar/fusion/pose_search.hpp"

namespace polar {

/// What all starts share.
struct StartContext {
  const Views& views;
  const std::vector<Eigen::Vector3f>& axes;
  std::vector<int> which;  // views that take part
  Subsets fitted;          // per view of `views`: localisations a start may fit
  Subsets held_out;        // per view: localisations that judge it
  std::uint64_t seed = 1;
};

struct AnnealingOptions {
  int sweeps = 30;
  int centres = 160;
  double first_width = 0.30, last_width = 0.10;  // of the template, in particle radii
  double first_beta = 0.05, last_beta = 1.0;     // inverse temperature of the pose posterior
  int rotations = 600;
  float shift = 0.12f;                           // of the translations tried
  int maximisations = 2;                         // EM steps a sweep
};

/// A template and poses (template_from_view, one for each of context.which) under competition.
struct Hypothesis {
  std::string name;
  Mixture mixture;
  std::vector<Pose> pose;
  double held_out = 0;  // mean log density per localisation that was not fitted
};

/// Kind of the first poses: random ones, or the particles as they were imaged.
enum class FirstPoses { random, imaged };

Hypothesis anneal(const StartContext& context, const AnnealingOptions& options, FirstPoses first, int number);

/// Mean log density of the held-out localisations, poses as they are.
double held_out_score(const StartContext& context, const Mixture& mixture, const std::vector<Pose>& pose, double width);

}  // namespace polar
