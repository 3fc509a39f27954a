// What a registration hands on: a pose with its covariance for every view, the fused template, and the
// account of how both were found.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/registration/symmetry.hpp"

namespace polar {

/// One view's result. Lengths are in units of Normalisation::scale_nm.
struct RegisteredView {
  Pose template_from_view;
  /// Covariance of (rotation, translation): left perturbation x -> exp(w) x + v in the template frame,
  /// rad^2, rad x length, length^2.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double log_likelihood = 0;    // mean natural log density per localisation (length^-3, planar length^-2)
  double posterior_share = 0;   // of the pose posterior that lies at this pose and not at another basin
  double margin = 0;            // log_likelihood minus that of the second-best basin found, >= 0
  double outlier_fraction = 0;  // expected share of localisations that the template does not explain
  double visibility = 1;        // estimated share of the template that the view shows
  int n_used = 0;
  bool accepted = false;
  std::string reason = "not registered";  // why rejected; empty when accepted
};

/// Mixture of centres, the fused template in its own frame.
struct FusedTemplate {
  Eigen::Matrix3Xd centre;  // 3 x K
  Eigen::VectorXd weight;   // K, sum 1
  double width = 0;         // standard deviation of every centre (label size), length
  double outlier_fraction = 0;
  double outlier_density = 0;  // length^-3 (planar length^-2)
};

/// sigma_eff^2 = a^2 sigma^2 + b^2, fitted by likelihood; far from a = 1, b = label size means that the
/// table's uncertainties do not describe its noise.
struct Calibration {
  double lateral_factor = 1, axial_factor = 1;  // a
  double lateral_extra = 0, axial_extra = 0;    // b, length
};

/// A hypothesis that competed: a start, or what was proposed to the best one.
struct StartReport {
  std::string name;                    // "random 3", "imaged", "regrown 1", ...
  double held_out_log_likelihood = 0;  // mean over views of the mean per localisation that was not fitted
  double gain = 0, gain_std = 0;  // of it over the best before: paired over views, and its standard error
  bool won = false;
};

/// One round of the refinement: a search where there was one, then template and poses in turn.
struct RoundReport {
  double width = 0;                    // of the template, length
  int moved = 0;                       // views that the round turned by more than 2 degrees
  double escaped = NAN;                // views that its search moved by more than 15 degrees; NaN: no search
  double held_out_log_likelihood = 0;  // as of a start
};

/// What a registration says of itself.
enum class Verdict { none, ambiguous, found };
std::string to_string(Verdict verdict);

/// An average that lost by evidence: the symmetric one, or the one without symmetry.
struct OtherTemplate {
  std::string group;  // C1: none
  FusedTemplate fused;
  double gain = 0, gain_std = 0;  // of views that other views predict, nat a label over the result
};

struct Registration {
  std::vector<RegisteredView> view;
  FusedTemplate fused;
  Calibration calibration;
  std::vector<StartReport> starts;
  /// Share of the views that the two best starts pose alike, up to one common rotation; 0 of a single start.
  double agreement = 0;
  Verdict verdict = Verdict::none;
  std::string verdict_reason;  // one sentence; empty: it never ran
  /// Held-out log density per localisation above that of a cloud without structure, and its standard error.
  double structure_gain = 0, structure_gain_std = 0;
  std::optional<OtherTemplate> other;  // where a symmetry was found or imposed
  std::optional<Symmetry> symmetry;    // where it is asked for
  std::vector<RoundReport> history;    // of the rounds that led to the result, and the last search
  int rounds = 0;
  bool converged = false;
  std::string stopped_because = "never ran";
  std::vector<std::string> warnings;
  std::string weights_sha256;  // of the autoencoder, where it took part; else empty
  struct Timing {
    std::string stage;
    double seconds = 0, processor_seconds = 0;  // of all threads of the process
  };
  std::vector<Timing> timings;
};

}  // namespace polar
