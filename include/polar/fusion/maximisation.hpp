// One expectation-maximisation step of the template, poses fixed. Every localisation enters with its own
// covariance, turned by its view's pose: mu_k = (sum r C^-1)^-1 sum r C^-1 x, everything in the template
// frame. Under a rotation group the sums of a centre are the mean over its images, each turned back: the
// exact step of a template whose free parameters are those of one asymmetric unit.
#pragma once

#include <cstdint>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/fusion_data.hpp"
#include "polar/fusion/mixture.hpp"
#include "polar/fusion/orbits.hpp"

namespace polar {

struct MaximisationOptions {
  bool free_weights = false;  // centres may weigh differently (discrete sites); else all equal
  bool support = true;        // weigh a centre by the share of views that support it (against strands)
  double weakest_share =
      0.05;  // a centre with less than this share of the mean is sown anew beside a strong one
  double reseed_distance = 0.05;  // where, in template units
  double smallest_outlier_fraction = 0.002;
  std::uint64_t seed = 0;  // of the sowing
  RotationGroup group;     // keeps a mixture that is closed under it so; nothing is then sown
};

struct MaximisationReport {
  double log_likelihood = 0;  // before the step, sum over localisations
};

/// Poses are template_from_view, one a view of `data`. Expects and leaves the centres sorted into blocks;
/// their order changes, so visibilities set on `data` must be set anew.
MaximisationReport maximise(Mixture& mixture, const FusionData& data,
                            const std::vector<Pose>& template_from_view, const MaximisationOptions& options);

}  // namespace polar
