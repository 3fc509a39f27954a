#include "fused_template.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kFuseStage = 55;
constexpr int kPool = 4096;       // localisations that a point's neighbours are sought among
constexpr float kPatch = 0.02f;   // radii: noise below the distance of points on a surface counts as this
constexpr float kNeighbour = 16;  // squared Mahalanobis distance beyond which a weight is nothing
constexpr double kUnsupported = 0.05;  // share that is dropped at least: views in wrong poses

struct Pool {
  Eigen::Matrix3Xf points;                 // frame of the template
  std::vector<Eigen::Matrix3f> precision;  // of each one's noise, frame of the template
  std::vector<int> view;
};

Pool drawn(const LatentViews& views, const std::vector<int>& which, const std::vector<Pose>& pose, int size,
           KeyedRandom random) {
  Pool pool;
  pool.points.resize(3, size);
  for (int j = 0; j < size; ++j) {
    const int i = which[random.below(which.size())];
    const LatentView& view = views.view[static_cast<std::size_t>(i)];
    const std::size_t l = random.below(static_cast<std::size_t>(view.points.cols()));
    const Eigen::Matrix3f back = pose[static_cast<std::size_t>(i)].rotation.cast<float>().transpose();
    const Eigen::Vector3f t = pose[static_cast<std::size_t>(i)].translation.cast<float>();
    pool.points.col(j) = back * (view.points.col(static_cast<Eigen::Index>(l)) - t);
    const Eigen::Matrix3f root = back * view.spread[l];
    const Eigen::Matrix3f patch = kPatch * kPatch * Eigen::Matrix3f::Identity();
    pool.precision.push_back((root * root.transpose() + patch).inverse());
    pool.view.push_back(i);
  }
  return pool;
}

double outliers_of(const LatentViews& views, const std::vector<int>& which) {
  double sum = 0;
  for (const int i : which) sum += views.view[static_cast<std::size_t>(i)].outlier_fraction;
  return sum / static_cast<double>(which.size());
}

}  // namespace

std::vector<int> best_views(const LatentViews& views, const std::vector<double>& loss, double share) {
  std::vector<int> order = with_localisations(views);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return loss[static_cast<std::size_t>(a)] < loss[static_cast<std::size_t>(b)];
  });
  order.resize(static_cast<std::size_t>(std::ceil(share * static_cast<double>(order.size()))));
  std::sort(order.begin(), order.end());
  return order;
}

Eigen::Matrix3Xf fused_template(const LatentViews& views, const std::vector<int>& which,
                                const std::vector<Pose>& pose, int count, std::uint64_t seed, int draw) {
  const Pool pool =
      drawn(views, which, pose, kPool, KeyedRandom(seed, static_cast<std::uint64_t>(draw), kFuseStage));
  const double dropped = which.size() > 1 ? std::max(kUnsupported, outliers_of(views, which)) : 0;
  const int tried = std::min(kPool, static_cast<int>(std::ceil(count / (1 - dropped))));
  Eigen::Matrix3Xf moved(3, tried);
  std::vector<float> support(static_cast<std::size_t>(tried));
  parallel_for(static_cast<std::size_t>(tried), [&](std::size_t j) {
    // The posterior mean of a localisation's place, all drawn ones being its prior (a step of mean shift).
    const Eigen::Matrix3f& precision = pool.precision[j];
    const Eigen::Vector3f x = pool.points.col(static_cast<Eigen::Index>(j));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float weight = 0, others = 0;
    for (int k = 0; k < kPool; ++k) {
      const Eigen::Vector3f d = pool.points.col(k) - x;
      const float e = d.dot(precision * d);
      if (e > kNeighbour) continue;
      const float w = std::exp(-0.5f * e);
      weight += w;
      sum += w * d;
      if (pool.view[static_cast<std::size_t>(k)] != pool.view[j]) others += w;
    }
    moved.col(static_cast<Eigen::Index>(j)) = x + sum / weight;
    support[j] = others;
  });
  std::vector<int> order(static_cast<std::size_t>(tried));
  for (int j = 0; j < tried; ++j) order[static_cast<std::size_t>(j)] = j;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return support[static_cast<std::size_t>(a)] > support[static_cast<std::size_t>(b)];
  });
  Eigen::Matrix3Xf out(3, std::min(count, tried));
  for (Eigen::Index j = 0; j < out.cols(); ++j) out.col(j) = moved.col(order[static_cast<std::size_t>(j)]);
  return out;
}

}  // namespace polar
