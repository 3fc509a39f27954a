#include "polar/results/strangers.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"

namespace polar {
namespace {

std::vector<PoseRow> particles(std::size_t n) {
  std::vector<PoseRow> rows(n);
  KeyedRandom random(1, 0, 0);
  for (std::size_t i = 0; i < n; ++i) {
    rows[i].particle = std::to_string(i);
    rows[i].accepted = true;
    rows[i].log_likelihood = 2 + 0.3 * random.normal();
  }
  return rows;
}

TEST(Strangers, AreFarFromTheMedianOnEitherSide) {
  std::vector<PoseRow> rows = particles(300);
  EXPECT_TRUE(strangers(rows).empty());
  rows[7].log_likelihood = -1;
  rows[9].log_likelihood = 6;
  rows[11].log_likelihood = 60;
  rows[11].accepted = false;
  const std::vector<Stranger> found = strangers(rows);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].particle, "9");
  EXPECT_NEAR(found[0].deviation, 4 / 0.3, 2);
  EXPECT_EQ(found[1].particle, "7");
  EXPECT_NEAR(found[1].deviation, -3 / 0.3, 2);
}

TEST(Strangers, AreNotFoundAmongFewOrWhereAllAreAlike) {
  std::vector<PoseRow> rows = particles(9);
  rows[0].log_likelihood = 100;
  EXPECT_TRUE(strangers(rows).empty());
  rows = particles(20);
  for (PoseRow& row : rows) row.log_likelihood = 1;
  rows[3].log_likelihood = 1.05;
  rows[4].log_likelihood = PoseRow::kNone;
  EXPECT_TRUE(strangers(rows).empty());
}

}  // namespace
}  // namespace polar
