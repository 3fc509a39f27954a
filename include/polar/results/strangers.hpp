// Accepted particles that fit the template unlike all the others: of another kind, two in one, or mostly
// something else.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "polar/results/pose_table.hpp"

namespace polar {

struct Stranger {
  std::string particle;
  /// Of its log likelihood from the median, in robust standard deviations. Negative: the template explains it
  /// badly; positive: it sits on few places of the template, as a smaller structure does.
  double deviation = 0;
};

/// Beyond these log likelihoods a particle is a stranger; NaN where fewer than ten are given.
struct StrangerLimits {
  double low = std::numeric_limits<double>::quiet_NaN(), high = low;
};
StrangerLimits stranger_limits(const std::vector<double>& log_likelihoods);

/// The particles more than 6 robust standard deviations (1.4826 times the median absolute deviation, at least
/// 0.02 nat) from the median, farthest first. None where fewer than ten particles are accepted.
std::vector<Stranger> strangers(const std::vector<PoseRow>& rows);

}  // namespace polar
