#include "polar/registration/prepare.hpp"

#include <gtest/gtest.h>

#include "polar/core/rng.hpp"
#include "smlm/error.hpp"

namespace polar {
namespace {

smlm::ParticleSet rings(int particles, int strays) {
  smlm::LocalisationTable t;
  KeyedRandom random(1, 0, 0);
  for (int p = 0; p < particles; ++p) {
    t.particle_names.push_back(std::to_string(p));
    for (int j = 0; j < 100; ++j) {
      const bool stray = j < strays;
      const double a = 6.283185307 * random.uniform(), r = stray ? 400 : 50;
      t.position_nm.push_back({1e5 + 1000.0 * p + r * std::cos(a), 2e5 + r * std::sin(a), 0});
      t.covariance_nm2.push_back({25, 0, 0, 25, 0, 100});
      t.particle.push_back(p);
    }
  }
  return smlm::group_particles(std::move(t));
}

TEST(PrepareViews, centreAndScaleStandThirtyPercentOfStrays) {
  const Views clean = prepare_views(rings(20, 0)), dirty = prepare_views(rings(20, 30));
  EXPECT_NEAR(clean.normalisation.scale_nm, 1.4 * 50, 3);
  EXPECT_NEAR(dirty.normalisation.scale_nm, clean.normalisation.scale_nm,
              0.25 * clean.normalisation.scale_nm);
  for (std::size_t i = 0; i < 20; ++i) {
    const Eigen::Vector3d truth(1e5 + 1000.0 * static_cast<double>(i), 2e5, 0);
    // 100 angles at random on a ring of 50 nm: the centre's standard error is 7 nm an axis; strays add
    // little.
    EXPECT_LT((clean.normalisation.centre_nm[i] - truth).norm(), 5 * 7);
    EXPECT_LT((dirty.normalisation.centre_nm[i] - truth).norm(), 5 * 7);
  }
}

TEST(PrepareViews, lengthsAndCovariancesShareOneUnit) {
  const Views v = prepare_views(rings(5, 0));
  const double s = v.normalisation.scale_nm;
  EXPECT_NEAR(double(v.view[0].covariance[0][0]), 25 / (s * s), 1e-6);
  EXPECT_NEAR(double(v.view[0].covariance[0][5]), 100 / (s * s), 1e-6);
}

TEST(PrepareViews, particlesWithoutExtentAreRefused) {
  smlm::ParticleSet one = rings(1, 0);
  for (auto& p : one.table.position_nm) p = {1, 2, 3};
  EXPECT_THROW(prepare_views(one), smlm::Error);
}

}  // namespace
}  // namespace polar
