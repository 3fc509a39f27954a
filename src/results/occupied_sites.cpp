#include "occupied_sites.hpp"

#include <algorithm>
#include <cmath>

namespace polar::results {

namespace {
constexpr double kWorth = 2;       // log likelihood that a site must add
constexpr double kNothing = 0.02;  // localisations that a site holds at least
constexpr int kSteps = 30, kStepsWithout = 8;

struct Shares {
  Eigen::VectorXd share;
  double log_likelihood = 0;
};

// Shares of the sites from where they are; a share of zero stays.
Shares fitted(const Eigen::MatrixXd& density, double background, Eigen::VectorXd share, int steps) {
  const auto n = static_cast<double>(density.rows());
  for (int step = 0; step < steps; ++step) {
    const Eigen::ArrayXd total = (density * share).array() + background;
    share = (share.array() * (density.transpose() * total.inverse().matrix()).array() / n).matrix();
  }
  return {share, ((density * share).array() + background).log().sum()};
}
}  // namespace

std::vector<std::size_t> occupied_sites(const Eigen::MatrixXd& density, double background, double odds) {
  const auto n = static_cast<double>(density.rows());
  const Eigen::Index sites = density.cols();
  Shares now = fitted(density, background, Eigen::VectorXd::Constant(sites, 1.0 / double(sites)), kSteps);
  now.share = (now.share.array() * n > kNothing).select(now.share, 0);
  std::vector<Eigen::Index> order;
  for (Eigen::Index k = 0; k < sites; ++k)
    if (now.share[k] > 0) order.push_back(k);
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return now.share[a] < now.share[b]; });
  std::vector<std::size_t> kept;
  for (const Eigen::Index k : order) {
    Eigen::VectorXd without = now.share;
    without[k] = 0;
    const Shares fewer = fitted(density, background, without, kStepsWithout);
    if (fewer.log_likelihood > now.log_likelihood - (kWorth - odds))
      now = fewer;
    else
      kept.push_back(static_cast<std::size_t>(k));
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace polar::results
