// Counter-based random numbers: a draw is a pure function of (seed, item, stage, counter), so neither
// the number of threads nor the order of work can change it. Philox4x32-10 (J. K. Salmon et al.,
// Parallel random numbers: as easy as 1, 2, 3, SC11, 2011).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace polar {

/// One block of Philox4x32-10.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// A stream of its own for each key; cheap to make, never shared.
class KeyedRandom {
 public:
  KeyedRandom(std::uint64_t seed, std::uint64_t item, std::uint32_t stage);

  std::uint32_t bits();
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  /// Uniform integer in [0, n), n > 0, without modulo bias worth mentioning (64-bit multiply-shift).
  std::uint64_t below(std::uint64_t n);
  /// Standard normal (Box-Muller, our own: std::normal_distribution differs between libraries).
  double normal();
  /// Poisson with mean >= 0 (inversion for small means, sum of halves above 30).
  std::uint64_t poisson(double mean);
  /// Haar-uniform rotation.
  Eigen::Matrix3d rotation();
  /// Uniform direction on the unit sphere.
  Eigen::Vector3d direction();

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
  bool has_spare_ = false;
  double spare_ = 0;
};

/// The numbers 0 ... n - 1 in random order.
std::vector<std::uint32_t> random_order(std::size_t n, KeyedRandom random);

}  // namespace polar
