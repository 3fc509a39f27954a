#include <algorithm>
#include <cmath>
#include <limits>

#include "polar/core/rng.hpp"
#include "polar/fitting/modes.hpp"

namespace polar::fitting {

namespace {
constexpr std::size_t kMostLocalisations = 5000;
constexpr int kSteps = 30;
constexpr std::uint32_t kLandmarkStage = 0xf8;
}  // namespace

// k-means (S. Lloyd, IEEE Trans. Inf. Theory 28, 129, 1982) from distant localisations (D. Arthur and S.
// Vassilvitskii, SODA 2007).
Eigen::Matrix3Xd landmarks(const FitData& superparticle, int count, std::uint64_t seed) {
  auto order = random_order(superparticle.size(), KeyedRandom(seed, 0, kLandmarkStage));
  order.resize(std::min(order.size(), kMostLocalisations));
  const FitData some = some_of(superparticle, order);
  const Eigen::Index n = some.x_nm.cols(), k = std::min<Eigen::Index>(count, n);
  KeyedRandom random(seed, 1, kLandmarkStage);
  Eigen::Matrix3Xd centre(3, k);
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(n, std::numeric_limits<double>::max());
  for (Eigen::Index c = 0; c < k; ++c) {
    Eigen::Index chosen = 0;
    if (c > 0) {
      double u = random.uniform() * nearest.sum();
      while (chosen + 1 < n && u >= nearest[chosen]) u -= nearest[chosen++];
    }
    centre.col(c) = some.x_nm.col(chosen);
    nearest = nearest.cwiseMin((some.x_nm.colwise() - centre.col(c)).colwise().squaredNorm().transpose());
  }
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, k);
    Eigen::VectorXd members = Eigen::VectorXd::Zero(k);
    for (Eigen::Index i = 0; i < n; ++i) {
      Eigen::Index best = 0;
      (centre.colwise() - some.x_nm.col(i)).colwise().squaredNorm().minCoeff(&best);
      sum.col(best) += some.x_nm.col(i), members[best] += 1;
    }
    for (Eigen::Index c = 0; c < k; ++c)
      if (members[c] > 0) centre.col(c) = sum.col(c) / members[c];
  }
  return centre;
}

}  // namespace polar::fitting
