// Localisations that are fitted and localisations that judge, in whole bursts.
#pragma once

#include <cstdint>

#include "polar/fitting/fit_data.hpp"

namespace polar::fitting {

struct Halves {
  FitData fitted, judging;
};

/// kJudging of the localisations judge, as near as whole bursts allow; which, seed and particle say.
Halves halves_of(const FitData& data, std::uint64_t seed, std::uint64_t particle);
constexpr double kJudging = 0.3;

}  // namespace polar::fitting
