#include "self_similarity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/fusion/fusion_data.hpp"

namespace polar {

namespace {

constexpr double kWidth = 0.06;  // particle radii; wider than centres err, narrower than sites are apart
constexpr Eigen::Index kMostPoints = 256;
constexpr int kTurnsAtRandom = 128;
constexpr std::uint32_t kTurnStage = 41;
constexpr double kTheSame = 0.7;  // similarity; a template that is symmetric but for noise has 0.8 to 1
const std::vector<Eigen::Vector3f> kAnyAxis = {Eigen::Vector3f::UnitZ()};  // the width is isotropic

NoiseModel noise(bool planar) {
  NoiseModel n;
  n.planar = planar;
  n.width = kWidth;
  return n;
}

// The centres as one view; where there are many, or their weights differ, evenly through the summed weight.
Views as_view(const Mixture& m, bool planar) {
  const bool alike = m.weight.maxCoeff() < 1.01f * m.weight.minCoeff();
  const Eigen::Index n = alike ? std::min(m.size(), kMostPoints) : kMostPoints;
  Views views;
  views.planar = planar;
  View view;
  view.points.resize(3, n);
  const double step = static_cast<double>(m.weight.sum()) / static_cast<double>(n);
  double passed = static_cast<double>(m.weight[0]);
  for (Eigen::Index j = 0, k = 0; j < n; ++j) {
    while (passed < (static_cast<double>(j) + 0.5) * step && k + 1 < m.size())
      passed += static_cast<double>(m.weight[++k]);
    view.points.col(j) = m.centre.col(k);
  }
  view.covariance.assign(static_cast<std::size_t>(n), Symmetric3{});
  views.view.push_back(std::move(view));
  return views;
}

Eigen::Vector3d mean_of(const Mixture& m) {
  return (m.centre * m.weight).cast<double>() / static_cast<double>(m.weight.sum());
}

Pose about(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) {
  return {turn, centre - turn * centre};
}

}  // namespace

SelfSimilarity::SelfSimilarity(const Mixture& mixture, bool planar)
    : mixture_(mixture),
      views_(as_view(mixture, planar)),
      classes_(sigma_classes(views_, kAnyAxis, noise(planar), 1)),
      volumes_(mixture, classes_, 1, planar),
      search_view_(search_view(views_.view[0], kAnyAxis[0], noise(planar), classes_, {})),
      centroid_(mean_of(mixture)) {
  std::vector<Pose> any;
  KeyedRandom random(0, 0, kTurnStage);
  double sum = 0;
  coarse_any_ = 0, coarse_own_ = 1;
  for (int i = 0; i < kTurnsAtRandom; ++i) {
    const Eigen::Matrix3d turn = planar ? so3_exp({0, 0, 2 * kPi * random.uniform()}) : random.rotation();
    sum += coarse(turn, centroid_);
    any.push_back(about(turn, centroid_));
  }
  coarse_own_ = coarse(Eigen::Matrix3d::Identity(), centroid_);
  coarse_any_ = sum / kTurnsAtRandom;
  exact_own_ = log_density({Pose{}});
  exact_any_ = log_density(any);
}

double SelfSimilarity::coarse(const Eigen::Matrix3d& turn, const Eigen::Vector3d& centre) const {
  const Pose motion = about(turn, centre);
  const double score = static_cast<double>(volumes_.score(search_view_, 0, turn.cast<float>(),
                                                          motion.translation.cast<float>())) /
                       static_cast<double>(search_view_.count);
  return (score - coarse_any_) / (coarse_own_ - coarse_any_);
}

double SelfSimilarity::exact(const std::vector<Pose>& motion) const {
  return (log_density(motion) - exact_any_) / (exact_own_ - exact_any_);
}

double SelfSimilarity::log_density(const std::vector<Pose>& motion) const {
  const FusionData data(views_, kAnyAxis, noise(planar()), {}, std::vector<int>(motion.size(), 0));
  const std::vector<double> mean = mean_log_likelihood(mixture_, data, motion);
  return std::accumulate(mean.begin(), mean.end(), 0.0) / static_cast<double>(mean.size());
}

int twins(const Mixture& mixture, bool planar, const std::vector<Pose>& before,
          const std::vector<Pose>& after, const std::vector<std::size_t>& moved) {
  if (moved.empty()) return 0;
  const SelfSimilarity of_template(mixture, planar);
  std::vector<char> same(moved.size(), 0);
  parallel_for(moved.size(), [&](std::size_t k) {
    const Pose motion = after[moved[k]] * before[moved[k]].inverse();
    same[k] = of_template.exact({motion}) >= kTheSame ? 1 : 0;
  });
  return static_cast<int>(std::count(same.begin(), same.end(), 1));
}

}  // namespace polar
