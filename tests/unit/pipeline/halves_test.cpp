#include "pipeline/halves.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace polar {
namespace {

// `distinct` particles of three localisations each, and then a copy of every one under another name.
smlm::ParticleSet with_copies(int distinct, bool copies) {
  smlm::LocalisationTable table;
  table.files = {"t.csv"};
  for (int p = 0; p < (copies ? 2 : 1) * distinct; ++p) {
    table.particle_names.push_back(std::to_string(p));
    for (int i = 0; i < 3; ++i) {
      table.position_nm.push_back({100.0 * (p % distinct) + i, 7.0 * i, 1.0 * i});
      table.covariance_nm2.push_back({4, 0, 0, 4, 0, 16});
      table.particle.push_back(p);
      table.source_file.push_back(0);
      table.source_row.push_back(table.size());
    }
  }
  return smlm::group_particles(table);
}

TEST(Halves, CopiesStayInOneHalf) {
  constexpr int kDistinct = 20;
  for (std::uint64_t seed = 1; seed < 5; ++seed) {
    const std::vector<bool> second = pipeline::second_half(with_copies(kDistinct, true), seed);
    for (int p = 0; p < kDistinct; ++p)
      EXPECT_EQ(second[static_cast<std::size_t>(p)], second[static_cast<std::size_t>(p + kDistinct)]) << seed;
    const auto in_second = std::count(second.begin(), second.end(), true);
    EXPECT_GT(in_second, 0);
    EXPECT_LT(in_second, 2 * kDistinct);
  }
}

TEST(Halves, WithoutCopiesTheyAreOfEqualSize) {
  const std::vector<bool> second = pipeline::second_half(with_copies(20, false), 1);
  EXPECT_EQ(std::count(second.begin(), second.end(), true), 10);
}

}  // namespace
}  // namespace polar
