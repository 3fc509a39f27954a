// The engine's front door: views in, poses and the fused template out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/pose_prior.hpp"
#include "polar/core/progress.hpp"
#include "polar/core/view.hpp"
#include "polar/latent/options.hpp"
#include "polar/registration/checkpoint.hpp"
#include "polar/registration/engine_options.hpp"
#include "polar/registration/registration.hpp"

namespace polar {

/// A structure that is known beforehand, in its own frame.
struct KnownTemplate {
  Eigen::Matrix3Xd site_nm;
  std::vector<double> weight;  // one a site
};

struct RegistrationOptions {
  std::uint64_t seed = 1;                                           // every random choice follows from it
  std::vector<std::string> starts = {"polar", "random", "imaged"};  // hypotheses that compete
  std::string method = "likelihood";  // likelihood | latent: the paper's registration and nothing after it
  std::string search = "fast";        // fast | exhaustive
  std::string optimizer = "levenberg_marquardt";  // of the latent registration: | adamw (the paper's)
  std::string weights;                            // of the autoencoder; empty: those that ship
  LatentOptions latent;                           // seed, search and optimizer are taken from here
  std::string symmetry = "auto";  // auto | none | detect | C<n>, D<n>, T, O, I: imposed on the template
  double tilt_deg = 0;            // 0: any orientation; else standard deviation of particles that lie upright
  bool flip = false;              // or upside down
  KnownTemplate known;            // of the start `template`; no sites: none is known
  EngineOptions engine;
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const RegistrationOptions& options);

/// What is known of orientations beforehand.
PosePrior prior_of(const RegistrationOptions& options);

/// Whether `start` is among those that compete.
bool wants(const RegistrationOptions& options, const std::string& start);

/// Whether the autoencoder takes part: as the method or as one of the starts.
bool needs_weights(const RegistrationOptions& options);

/// Registers all views. Never throws for a bad view: that view is not accepted and says why.
Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress);

/// The same; leaves its states in `checkpoint` and goes on from those that it finds there, to the same bits
/// as without a break. A cancelled run returns early and says so in stopped_because. `method: latent` keeps
/// no states: it begins again.
Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress,
                            Checkpoint& checkpoint);

/// The same from poses that are given (template_from_view, one a view) instead of a competition of starts: to
/// continue elsewhere, or to ask whether a true pose would have scored better than the found one.
Registration register_from(const Views& views, const std::vector<Pose>& template_from_view,
                           const RegistrationOptions& options, Progress& progress);

}  // namespace polar
