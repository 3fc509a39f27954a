#include "polar/fusion/maximisation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "blocked_mixture.hpp"
#include "fusion_data_impl.hpp"
#include "mixture_kernel_choice.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {

constexpr std::size_t kMostBlocks = 64;      // partial sums held at once
constexpr std::uint32_t kSowingStage = 11;   // key of the random stream
constexpr double kPseudoLocalisations = 20;  // prior of the outlier fraction: one in twenty
constexpr double kPseudoOutliers = 1;

// Sums over the views of a block, template frame.
struct Sums {
  std::vector<double> total;            // kSums x K
  std::vector<double> share, share_sq;  // over views, of the view's normalised responsibility; K
  double log_likelihood = 0, inliers = 0, localisations = 0;

  Sums& operator+=(const Sums& o) {
    if (total.empty()) return *this = o;
    const auto add = [](std::vector<double>& a, const std::vector<double>& b) {
      for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
    };
    add(total, o.total), add(share, o.share), add(share_sq, o.share_sq);
    log_likelihood += o.log_likelihood, inliers += o.inliers, localisations += o.localisations;
    return *this;
  }
};

// Moves the sums of centre `k` into another frame and adds `part` of them to those of centre `to`.
template <typename Number>
void add_turned(const Number* sums, std::size_t stride, std::size_t k, const Eigen::Matrix3d& r,
                const Eigen::Vector3d& t, double part, double* total, std::size_t out_stride,
                std::size_t to) {
  const auto s = [&](std::size_t i) { return static_cast<double>(sums[i * stride + k]); };
  Eigen::Matrix3d p;
  p << s(1), s(2), s(3), s(2), s(4), s(5), s(3), s(5), s(6);
  const Eigen::Matrix3d turned = r * p * r.transpose();
  const Eigen::Vector3d px = r * Eigen::Vector3d(s(7), s(8), s(9)) + turned * t;
  const double out[kernel::kSums] = {s(0),         turned(0, 0), turned(0, 1), turned(0, 2), turned(1, 1),
                                     turned(1, 2), turned(2, 2), px[0],        px[1],        px[2]};
  for (std::size_t i = 0; i < kernel::kSums; ++i) total[i * out_stride + to] += part * out[i];
}

Sums sums_of(const BlockedMixture& blocked, std::size_t centres, const FusionData& data,
             const std::vector<Pose>& poses, std::size_t begin, std::size_t end) {
  const auto padded = static_cast<std::size_t>(blocked.padded_size());
  Sums sums;
  sums.total.assign(kernel::kSums * centres, 0.0);
  sums.share.assign(centres, 0.0);
  sums.share_sq.assign(centres, 0.0);
  ViewFrame frame(blocked);
  std::vector<float> own(kernel::kSums * padded), scratch(padded), inlier, density, buffer;
  for (std::size_t i = begin; i < end; ++i) {
    const KernelLocalisations& view = data.impl().view[i];
    if (view.empty()) continue;
    std::fill(own.begin(), own.end(), 0.0f);
    inlier.resize(view.size()), density.resize(view.size());
    mixture_kernel().accumulate(frame.at(poses[i].inverse(), view_weight(data, i, blocked.weight(), buffer)),
                                view.data(), static_cast<int>(view.size()), blocked.background(), own.data(),
                                inlier.data(), density.data(), scratch.data());
    double mine = 0;
    for (std::size_t j = 0; j < view.size(); ++j) mine += inlier[j];
    if (!std::isfinite(mine)) continue;  // one view's numbers shall not spoil the template
    sums.inliers += mine;
    sums.localisations += static_cast<double>(view.size());
    for (std::size_t j = 0; j < view.size(); ++j)
      sums.log_likelihood += std::log(static_cast<double>(density[j] + blocked.background()));
    for (std::size_t k = 0; k < centres; ++k) {
      if (own[k] == 0) continue;
      add_turned(own.data(), padded, k, poses[i].rotation, poses[i].translation, 1, sums.total.data(),
                 centres, k);
      const double share = own[k] / std::max(mine, 1e-12);
      sums.share[k] += share;
      sums.share_sq[k] += share * share;
    }
  }
  return sums;
}

// Every centre's sums become the mean over its orbit, as its own frame sees it.
void average_over(const std::vector<std::vector<Eigen::Index>>& orbits, const RotationGroup& group,
                  std::size_t n, Sums& sums) {
  const Sums own = sums;
  const double part = 1 / static_cast<double>(group.size());
  for (const auto& orbit : orbits) {
    std::vector<double> mean(kernel::kSums, 0.0);
    double share = 0, share_sq = 0;
    for (std::size_t g = 0; g < group.size(); ++g) {
      const auto k = static_cast<std::size_t>(orbit[g]);
      add_turned(own.total.data(), n, k, group[g].transpose(), Eigen::Vector3d::Zero(), part, mean.data(), 1,
                 0);
      share += part * own.share[k], share_sq += part * own.share_sq[k];
    }
    for (std::size_t g = 0; g < group.size(); ++g) {
      const auto k = static_cast<std::size_t>(orbit[g]);
      for (std::size_t s = 0; s < kernel::kSums; ++s) sums.total[s * n + k] = 0;  // met again: on an axis
      add_turned(mean.data(), 1, 0, group[g], Eigen::Vector3d::Zero(), 1, sums.total.data(), n, k);
      sums.share[k] = share, sums.share_sq[k] = share_sq;
    }
  }
}

// Sows the weakest centres anew beside strong ones, each strong one used once a step.
void sow_again(Mixture& mixture, const std::vector<double>& strength, const MaximisationOptions& options) {
  const std::size_t n = strength.size();
  const double mean = std::accumulate(strength.begin(), strength.end(), 0.0) / static_cast<double>(n);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return strength[a] < strength[b]; });
  KeyedRandom random(options.seed, 0, kSowingStage);
  for (std::size_t i = 0; i < n / 2 && strength[order[i]] < options.weakest_share * mean; ++i) {
    const auto weak = static_cast<Eigen::Index>(order[i]),
               strong = static_cast<Eigen::Index>(order[n - 1 - i]);
    Eigen::Vector3d away = random.direction();
    if (mixture.centre.row(2).isZero(0)) away.z() = 0;
    mixture.centre.col(weak) = mixture.centre.col(strong) + (options.reseed_distance * away).cast<float>();
    const float half = 0.5f * mixture.weight[strong];
    if (options.free_weights) mixture.weight[strong] = mixture.weight[weak] = half;
  }
}

}  // namespace

MaximisationReport maximise(Mixture& mixture, const FusionData& data, const std::vector<Pose>& poses,
                            const MaximisationOptions& options) {
  const BlockedMixture blocked(mixture);
  const auto centres = static_cast<std::size_t>(mixture.size());
  const std::size_t block = std::max<std::size_t>(4, (data.size() + kMostBlocks - 1) / kMostBlocks);
  Sums sums = ordered_sum(data.size(), block, Sums{}, [&](std::size_t begin, std::size_t end) {
    return sums_of(blocked, centres, data, poses, begin, end);
  });
  const auto orbit = options.group.empty() ? std::vector<std::vector<Eigen::Index>>{}
                                           : orbits(mixture.centre, options.group);
  average_over(orbit, options.group, centres, sums);

  std::vector<double> strength(centres, 0.0);
  double total_weight = 0;
  for (std::size_t k = 0; k < centres; ++k) {
    const auto s = [&](std::size_t i) { return sums.total[i * centres + k]; };
    const auto col = static_cast<Eigen::Index>(k);
    // Effective number of views behind a centre, (sum m)^2 / sum m^2, as a share of all views.
    const double support = sums.share_sq[k] > 0 ? sums.share[k] * sums.share[k] / sums.share_sq[k] /
                                                      static_cast<double>(data.size())
                                                : 0;
    strength[k] = options.support ? s(0) * support : s(0);
    const double weight = (options.free_weights ? s(0) : 1.0) * (options.support ? support * support : 1.0);
    mixture.weight[col] = static_cast<float>(weight);
    total_weight += weight;
    Eigen::Matrix3d a;
    a << s(1), s(2), s(3), s(2), s(4), s(5), s(3), s(5), s(6);
    if (data.planar()) a(2, 2) = 1;
    const double ridge = 1e-6 * a.trace() + 1e-12;  // a centre that nothing sees stays where it is
    const Eigen::Vector3d b =
        Eigen::Vector3d(s(7), s(8), s(9)) + ridge * mixture.centre.col(col).cast<double>();
    mixture.centre.col(col) = (a + ridge * Eigen::Matrix3d::Identity()).ldlt().solve(b).cast<float>();
  }
  mixture.weight /= static_cast<float>(std::max(total_weight, 1e-30));
  mixture.outlier_fraction = std::clamp(
      (sums.localisations - sums.inliers + kPseudoOutliers) / (sums.localisations + kPseudoLocalisations),
      options.smallest_outlier_fraction, 0.95);
  if (options.group.empty())
    sow_again(mixture, strength, options);
  else
    snap_to_orbits(mixture, options.group, orbit);
  sort_into_blocks(mixture);
  return {sums.log_likelihood};
}

}  // namespace polar
