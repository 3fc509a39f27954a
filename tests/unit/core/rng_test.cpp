#include "polar/core/rng.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "polar/core/sha256.hpp"

namespace polar {
namespace {

// Known answers of Philox4x32-10 from the test vectors of its authors' library, Random123.
TEST(Philox, knownAnswers) {
  const auto zero = philox4x32({0, 0, 0, 0}, {0, 0});
  EXPECT_EQ(zero, (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const auto ones = philox4x32({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u});
  EXPECT_EQ(ones, (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  const auto pi = philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0});
  EXPECT_EQ(pi, (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

// What every seed that anyone wrote down hangs on: how key and counter are filled, and in which order the
// words of a block are used.
TEST(KeyedRandom, theStreamOfAKeyIsFixedForGood) {
  KeyedRandom random(0x123456789abcdef, 7, 3);
  Sha256 hash;
  for (int i = 0; i < 4096; ++i) {
    const std::uint32_t word = random.bits();
    for (int shift = 0; shift < 32; shift += 8) {
      const auto byte = static_cast<unsigned char>(word >> shift);
      hash.add(&byte, 1);
    }
  }
  EXPECT_EQ(hash.digits(), "22b46c9caaa61a627de13af313fabbf44d42112b235b72a1d87708dd7286e029");
}

TEST(KeyedRandom, theSameKeyGivesTheSameStreamAndAnotherKeyAnother) {
  KeyedRandom a(7, 3, 1), b(7, 3, 1), c(7, 4, 1), d(7, 3, 2);
  int equal_c = 0, equal_d = 0;
  for (int i = 0; i < 100; ++i) {
    const auto v = a.bits();
    EXPECT_EQ(v, b.bits());
    equal_c += v == c.bits();
    equal_d += v == d.bits();
  }
  EXPECT_LE(equal_c, 1);
  EXPECT_LE(equal_d, 1);
}

TEST(KeyedRandom, momentsOfNormalAndPoisson) {
  constexpr int kDraws = 40000;
  KeyedRandom random(1, 0, 0);
  double sum = 0, square = 0, count = 0, count_square = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    sum += x, square += x * x;
    const auto n = static_cast<double>(random.poisson(45));
    count += n, count_square += n * n;
  }
  // Five standard errors of each mean.
  EXPECT_NEAR(sum / kDraws, 0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(square / kDraws, 1, 5 * std::sqrt(2.0 / kDraws));
  const double mean = count / kDraws;
  EXPECT_NEAR(mean, 45, 5 * std::sqrt(45.0 / kDraws));
  EXPECT_NEAR(count_square / kDraws - mean * mean, 45, 5 * 45 * std::sqrt(2.0 / kDraws));
}

TEST(KeyedRandom, rotationsAreHaarUniform) {
  // Under the Haar measure the trace of a rotation has mean 0 and mean square 1.
  constexpr int kDraws = 40000;
  KeyedRandom random(2, 0, 0);
  double trace = 0, square = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double t = random.rotation().trace();
    trace += t, square += t * t;
  }
  EXPECT_NEAR(trace / kDraws, 0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(square / kDraws, 1, 5 * 1.5 / std::sqrt(kDraws));
}

TEST(KeyedRandom, belowCoversItsRangeEvenly) {
  KeyedRandom random(3, 0, 0);
  std::array<int, 7> seen{};
  for (int i = 0; i < 7000; ++i) ++seen[random.below(7)];
  for (const int n : seen) EXPECT_NEAR(n, 1000, 5 * std::sqrt(1000.0));
}

TEST(RandomOrder, everyNumberOnceAndEveryPlaceEquallyOften) {
  constexpr std::size_t kNumbers = 5, kDraws = 20000;
  std::array<std::array<double, kNumbers>, kNumbers> share{};
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const auto order = random_order(kNumbers, KeyedRandom(11, draw, 2));
    ASSERT_THAT(order, testing::UnorderedElementsAre(0, 1, 2, 3, 4));
    for (std::size_t place = 0; place < kNumbers; ++place) share[place][order[place]] += 1.0 / kDraws;
  }
  for (const auto& place : share)
    for (double s : place) EXPECT_NEAR(s, .2, 5 * std::sqrt(.2 * .8 / kDraws));
}

}  // namespace
}  // namespace polar
