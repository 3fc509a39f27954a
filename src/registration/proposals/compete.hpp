// The coarse end of the loop: starts compete by evidence, templates grown again from a part of the views are
// proposed to the best of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "../anneal/soft_poses.hpp"
#include "polar/core/progress.hpp"
#include "polar/model/autoencoder.hpp"
#include "polar/registration/register.hpp"

namespace polar {

struct Competition {
  SoftState winner;
  bool crowded = false;  // of which problem the winner is
  std::vector<StartReport> report;
  double agreement = 0;   // of the two best that know nothing of each other
  bool finished = false;  // false: cancelled
  std::vector<std::string> warnings = {};
};

/// `model`: of the start `polar`; null where it is not wanted.
Competition compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                    Progress& progress);

/// Share of the views that two lists of poses place alike, up to the common rotation that suits most of them.
double share_alike(const std::vector<SoftPose>& a, const std::vector<SoftPose>& b,
                   const std::vector<int>& which, double within_rad);

}  // namespace polar
