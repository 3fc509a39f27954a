#include "polar/fusion/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "blocked_mixture.hpp"
#include "fusion_data_impl.hpp"
#include "kernel_choice.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {
// For every centre those within `reach`, itself among them.
std::vector<std::vector<std::size_t>> neighbours_within(const Mixture& m, double reach) {
  std::vector<std::vector<std::size_t>> out(static_cast<std::size_t>(m.size()));
  const auto r2 = static_cast<float>(reach * reach);
  for (Eigen::Index k = 0; k < m.size(); ++k)
    for (Eigen::Index l = 0; l < m.size(); ++l)
      if (l == k || (m.centre.col(k) - m.centre.col(l)).squaredNorm() < r2)
        out[static_cast<std::size_t>(k)].push_back(static_cast<std::size_t>(l));
  return out;
}

constexpr int kIterations = 6;
constexpr float kLeastWeight = 1e-12f;  // of a centre before a factor on it means anything
}  // namespace

std::vector<std::vector<float>> occupancy(const Mixture& mixture, const FusionData& evidence,
                                          const std::vector<Pose>& poses, double strength, double reach) {
  std::vector<std::vector<float>> factors(evidence.size());
  if (!std::isfinite(strength)) return factors;
  const BlockedMixture blocked(mixture);
  const auto centres = static_cast<std::size_t>(mixture.size());
  const auto padded = static_cast<std::size_t>(blocked.padded_size());
  const auto near = neighbours_within(mixture, reach);
  std::vector<double> share(centres, 0.0);
  for (std::size_t k = 0; k < centres; ++k)
    for (const std::size_t l : near[k]) share[k] += mixture.weight[static_cast<Eigen::Index>(l)];
  parallel_for(evidence.size(), [&](std::size_t i) {
    const KernelLocalisations& view = evidence.impl().view[i];
    if (view.empty()) return;
    ViewFrame frame(blocked);
    const Pose pose = poses[i].inverse();
    std::vector<float> factor(centres, 1.0f), weight(padded, 0.0f), sums(kernel::kSums * padded),
        scratch(padded);
    std::vector<float> inlier(view.size()), density(view.size());
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      for (std::size_t k = 0; k < centres; ++k) weight[k] = blocked.weight()[k] * factor[k];
      std::fill(sums.begin(), sums.end(), 0.0f);
      mixture_kernel().accumulate(frame.at(pose, weight.data()), view.data(), static_cast<int>(view.size()),
                                  blocked.background(), sums.data(), inlier.data(), density.data(),
                                  scratch.data());
      double total = 0;
      for (std::size_t k = 0; k < centres; ++k) total += static_cast<double>(sums[k]);
      const double prior = strength * static_cast<double>(centres);
      for (std::size_t k = 0; k < centres; ++k) {
        if (mixture.weight[static_cast<Eigen::Index>(k)] < kLeastWeight) continue;
        double seen = 0;
        for (const std::size_t l : near[k]) seen += static_cast<double>(sums[l]);
        factor[k] = static_cast<float>((seen / share[k] + prior) / (total + prior));
      }
    }
    factors[i] = std::move(factor);
  });
  return factors;
}

std::vector<std::vector<double>> attributed(const Mixture& mixture, const FusionData& data,
                                            const std::vector<Pose>& poses) {
  const BlockedMixture blocked(mixture);
  const auto padded = static_cast<std::size_t>(blocked.padded_size());
  std::vector<std::vector<double>> count(data.size());
  parallel_for(data.size(), [&](std::size_t i) {
    const KernelLocalisations& view = data.impl().view[i];
    if (view.empty()) return;
    ViewFrame frame(blocked);
    std::vector<float> sums(kernel::kSums * padded, 0.0f), scratch(padded), inlier(view.size()),
        density(view.size());
    mixture_kernel().accumulate(frame.at(poses[i].inverse(), blocked.weight()), view.data(),
                                static_cast<int>(view.size()), blocked.background(), sums.data(),
                                inlier.data(), density.data(), scratch.data());
    count[i].assign(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(mixture.size()));
  });
  return count;
}

double likeliest_strength(const Mixture& mixture, const FusionData& data, const std::vector<Pose>& poses,
                          double reach) {
  // Patches: a centre joins the heaviest one before it within reach, so that counts are added once.
  const auto centres = static_cast<std::size_t>(mixture.size());
  const auto near = neighbours_within(mixture, reach);
  std::vector<std::size_t> order(centres), patch(centres, centres);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return mixture.weight[static_cast<Eigen::Index>(a)] > mixture.weight[static_cast<Eigen::Index>(b)];
  });
  std::size_t patches = 0;
  for (const std::size_t k : order) {
    if (patch[k] < centres) continue;
    for (const std::size_t l : near[k])
      if (patch[l] == centres) patch[l] = patches;
    ++patches;
  }
  std::vector<double> share(patches, 0.0);
  for (std::size_t k = 0; k < centres; ++k)
    share[patch[k]] += static_cast<double>(mixture.weight[static_cast<Eigen::Index>(k)]);
  std::vector<std::vector<double>> count(data.size(), std::vector<double>(patches, 0.0));
  const std::vector<std::vector<double>> of_centre = attributed(mixture, data, poses);
  for (std::size_t i = 0; i < data.size(); ++i)
    for (std::size_t k = 0; k < of_centre[i].size(); ++k) count[i][patch[k]] += of_centre[i][k];
  const auto evidence = [&](double strength) {
    double total = 0;
    for (const std::vector<double>& n : count) {
      double all = 0;
      for (std::size_t p = 0; p < patches; ++p) {
        if (share[p] < static_cast<double>(kLeastWeight)) continue;
        all += n[p];
        total += std::isfinite(strength)
                     ? std::lgamma(strength * share[p] + n[p]) - std::lgamma(strength * share[p])
                     : n[p] * std::log(share[p]);
      }
      if (std::isfinite(strength)) total += std::lgamma(strength) - std::lgamma(strength + all);
    }
    return total;
  };
  double best = std::numeric_limits<double>::infinity(), most = evidence(best);
  for (double total = 1024; total >= 4; total /= 2) {
    const double e = evidence(total);
    if (e > most) most = e, best = total / static_cast<double>(centres);
  }
  return best;
}

double shown_share(const Mixture& mixture, const std::vector<float>& factor) {
  if (factor.empty()) return 1;
  double share = 0;
  for (std::size_t k = 0; k < factor.size(); ++k)
    share += static_cast<double>(mixture.weight[static_cast<Eigen::Index>(k)] * std::min(1.0f, factor[k]));
  return share;
}

}  // namespace polar
