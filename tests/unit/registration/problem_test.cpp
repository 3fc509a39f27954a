#include "registration/problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "polar/core/rng.hpp"

namespace polar {
namespace {

Views views_of(const std::vector<int>& sizes) {
  Views views;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    KeyedRandom random(3, i, 1);
    View view;
    view.points.resize(3, sizes[i]);
    for (Eigen::Index j = 0; j < sizes[i]; ++j) view.points.col(j) = random.direction().cast<float>();
    view.covariance.assign(static_cast<std::size_t>(sizes[i]), {1e-3f, 0, 1e-3f, 0, 0, 1e-3f});
    views.view.push_back(view);
  }
  return views;
}

TEST(Aligned, takesTheHeldOutOfAViewWhoseFittedAreFew) {
  const Views views = views_of({50, 400, 0});
  const Problems problems = make_problems(views, 1);
  for (const Problem* p : {&problems.thinned, &problems.plain}) {
    const Subsets subsets = aligned(*p, 96);
    ASSERT_EQ(subsets.size(), 3u);
    EXPECT_EQ(subsets[0].size(), p->fitted[0].size() + p->held_out[0].size());
    EXPECT_EQ(std::set<std::uint32_t>(subsets[0].begin(), subsets[0].end()).size(), subsets[0].size());
    EXPECT_TRUE(std::equal(p->fitted[0].begin(), p->fitted[0].end(), subsets[0].begin()));
    EXPECT_EQ(subsets[1], first_of(p->fitted, 96)[1]);
    EXPECT_TRUE(subsets[2].empty());
  }
  EXPECT_EQ(aligned(problems.plain, 96)[0].size(), 50u);
}

}  // namespace
}  // namespace polar
