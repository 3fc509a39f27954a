// A result as a perfect engine would give it, made from a simulation and its truth.
#pragma once

#include "polar/results/results.hpp"
#include "polar/simulation/simulate.hpp"

namespace polar::support {

/// Groups by particle; views are centred on their mean and scaled by 100 nm; particle 1 is rejected.
Results perfect_results(const Simulation& simulation, const Structure& structure);

}  // namespace polar::support
