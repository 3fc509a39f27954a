// What the speed benchmarks share: one simulated data set, counters, and the floors that numbers are held
// against.
#pragma once

#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>

#include "polar/registration/prepare.hpp"
#include "polar/simulation/simulate.hpp"

namespace polar::bench {

/// Nuclear pores in random orientations; the same table whenever it is asked for.
inline Simulation pores(int particles) {
  SimulationOptions o;
  o.particles = particles;
  o.blinks_mean = 20;  // about 500 localisations a particle
  o.cramer_rao = false;
  return simulate(make_structure({}), o);
}

/// `amount` a second of the timed region, with k, M, G.
inline void rate(benchmark::State& state, const char* name, double amount_per_iteration) {
  state.counters[name] = benchmark::Counter(amount_per_iteration * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
}

/// Peak memory of the process so far, MiB.
inline void peak_memory(benchmark::State& state) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  state.counters["peak_MiB"] = static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts KiB
}

/// Seconds of the fastest of `tries` calls: a floor measured on the machine at hand.
template <class Work>
double fastest_seconds(int tries, Work work) {
  double best = 1e300;
  for (int t = 0; t < tries; ++t) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// Floor's time over this benchmark's wall time: 1 would be as fast as the floor. A plain share, though the
/// library prints it with "/s" as every rate.
inline void share_of_floor(benchmark::State& state, double floor_seconds) {
  state.counters["share_of_floor"] = benchmark::Counter(
      floor_seconds * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

}  // namespace polar::bench
