#include "polar/core/rng.hpp"

#include <Random123/philox.h>
#undef philox4x32  // a macro of the library

#include <cmath>
#include <numeric>
#include <utility>

#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"

namespace polar {

namespace {
constexpr double kLargeMean = 30.0;  // exp(-30) is still far from underflow

std::uint32_t low(std::uint64_t v) { return static_cast<std::uint32_t>(v); }
std::uint32_t high(std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); }
}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> c, std::array<std::uint32_t, 2> k) {
  constexpr int kRounds = 10;
  const r123::Philox4x32_R<kRounds>::ctr_type block =
      r123::Philox4x32_R<kRounds>()({{c[0], c[1], c[2], c[3]}}, {{k[0], k[1]}});
  return {block[0], block[1], block[2], block[3]};
}

KeyedRandom::KeyedRandom(std::uint64_t seed, std::uint64_t item, std::uint32_t stage)
    : key_{low(seed), high(seed)}, counter_{0, stage, low(item), high(item)} {}

std::uint32_t KeyedRandom::bits() {
  if (used_ == 4) {
    block_ = philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

double KeyedRandom::uniform() {
  const std::uint64_t a = bits() >> 5, b = bits() >> 6;
  return static_cast<double>((a << 26) | b) * 0x1.0p-53;
}

std::uint64_t KeyedRandom::below(std::uint64_t n) {
  const std::uint64_t r = (std::uint64_t{bits()} << 32) | bits();
  return static_cast<std::uint64_t>((static_cast<long double>(r) * 0x1.0p-64L) * static_cast<long double>(n));
}

double KeyedRandom::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = kTwoPi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t KeyedRandom::poisson(double mean) {
  if (mean > kLargeMean) return poisson(mean / 2) + poisson(mean / 2);
  const double limit = std::exp(-mean);
  std::uint64_t n = 0;
  double product = uniform();
  while (product > limit) {
    product *= uniform();
    ++n;
  }
  return n;
}

Eigen::Matrix3d KeyedRandom::rotation() {
  const double u1 = uniform(), u2 = uniform(), u3 = uniform();
  return haar_rotation(u1, u2, u3).toRotationMatrix();
}

Eigen::Vector3d KeyedRandom::direction() {
  const double z = 2.0 * uniform() - 1.0, phi = kTwoPi * uniform(), r = std::sqrt(1.0 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

std::vector<std::uint32_t> random_order(std::size_t n, KeyedRandom random) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

}  // namespace polar
