#include "model/training_cloud.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "model/procedural.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kStage = 0x7261696eu;  // of the run's keyed random numbers
constexpr int kCleanPoints = 1024;
constexpr double kMinSigma = 0.005;
constexpr double kMaxStretch = 1.6;

double between(KeyedRandom& r, double low, double high) { return low + (high - low) * r.uniform(); }
double log_between(KeyedRandom& r, double low, double high) {
  return low * std::pow(high / low, r.uniform());
}

Eigen::Matrix3Xf clean_cloud(const TrainData& data, const ShapeSet& shapes, KeyedRandom& random) {
  const std::uint64_t n = shapes.size();
  if (n == 0 || random.uniform() < data.procedural_share) return procedural_cloud(kCleanPoints, random, data);
  const std::uint64_t index = random.below(n);
  Eigen::Matrix3Xf cloud = shapes.sample(index, kCleanPoints, random);
  if (random.uniform() < data.stretch_share) {
    const Eigen::Matrix3d axes = random.uniform() < 0.5 ? Eigen::Matrix3d::Identity() : random.rotation();
    Eigen::Vector3d stretch;
    for (int a = 0; a < 3; ++a) stretch[a] = log_between(random, 1, kMaxStretch);
    const Eigen::Matrix3d linear = axes.transpose() * stretch.asDiagonal() * axes;
    cloud = (linear.cast<float>() * cloud).eval();
  }
  centre_and_normalise(cloud);
  return cloud;
}

/// Indices of `keep` points: those farthest along a random direction survive a cut, and where the density is
/// uneven a point's chance grows by up to a factor e^2 along another direction.
std::vector<Eigen::Index> surviving(const Eigen::Matrix3Xf& cloud, const Degradation& d,
                                    KeyedRandom& random) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(cloud.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto sort_by = [&](const Eigen::VectorXd& key) {
    std::stable_sort(order.begin(), order.end(),
                     [&](Eigen::Index a, Eigen::Index b) { return key[a] > key[b]; });
  };
  if (random.uniform() < d.cut_share) {
    const Eigen::Vector3f normal = random.direction().cast<float>();
    sort_by((normal.transpose() * cloud).cast<double>());
    const double visibility = between(random, d.min_visibility, 1);
    order.resize(static_cast<std::size_t>(std::ceil(visibility * static_cast<double>(cloud.cols()))));
  }
  const bool full = random.uniform() < d.full_share;
  const double wanted = full ? d.max_points : std::round(log_between(random, d.min_points, d.max_points));
  const std::size_t keep = std::min(order.size(), static_cast<std::size_t>(wanted));
  // Weighted choice without repetition: the largest of log(u) / weight (Efraimidis and Spirakis, 2006).
  Eigen::Vector3f slope = Eigen::Vector3f::Zero();
  if (random.uniform() < d.uneven_share) slope = (2 * random.uniform() * random.direction()).cast<float>();
  Eigen::VectorXd key(cloud.cols());
  for (Eigen::Index i = 0; i < cloud.cols(); ++i)
    key[i] = std::log(1 - random.uniform()) * std::exp(-static_cast<double>(slope.dot(cloud.col(i))));
  sort_by(key);
  order.resize(keep);
  return order;
}

/// Every point becomes one of the first few: labels that are missing, and others that blink many times.
void repeat_few_labels(std::vector<Eigen::Index>& points, const Degradation& d, KeyedRandom& random) {
  // At 0 nothing is drawn, so that older trainings repeat to the bit.
  if (d.few_labels_share == 0 || random.uniform() >= d.few_labels_share) return;
  const auto labels = static_cast<std::uint64_t>(log_between(random, d.min_labels, d.max_labels));
  const std::uint64_t distinct = std::min<std::uint64_t>(labels, points.size());
  for (std::size_t i = distinct; i < points.size(); ++i) points[i] = points[random.below(distinct)];
}

void add_noise(Eigen::Matrix3Xf& cloud, const Degradation& d, KeyedRandom& random) {
  if (random.uniform() < d.clean_share) return;
  const double sigma = log_between(random, kMinSigma, d.max_sigma);
  // The most of the noise is along the view's own z, as in a microscope; its orientation follows the
  // cloud's random one.
  const double axial = random.uniform() < d.anisotropic_share ? between(random, 1.5, 6) : 1;
  const bool per_point = random.uniform() < d.per_point_share;
  const Eigen::Vector3d s(sigma, sigma, std::min(axial * sigma, std::max(sigma, 2 * d.max_sigma)));
  for (Eigen::Index i = 0; i < cloud.cols(); ++i) {
    const double own = per_point ? std::exp(0.5 * random.normal()) : 1;
    for (int a = 0; a < 3; ++a) cloud(a, i) += static_cast<float>(own * s[a] * random.normal());
  }
}
}  // namespace

Eigen::Matrix3Xf degrade(const Degradation& d, KeyedRandom& random, Eigen::Matrix3Xf& target) {
  std::vector<Eigen::Index> kept = surviving(target, d, random);
  repeat_few_labels(kept, d, random);
  Eigen::Matrix3Xf input(3, static_cast<Eigen::Index>(kept.size()));
  for (std::size_t i = 0; i < kept.size(); ++i) input.col(static_cast<Eigen::Index>(i)) = target.col(kept[i]);
  add_noise(input, d, random);
  if (random.uniform() < d.recentre_share) {
    const Eigen::Vector3f mean = input.rowwise().mean();
    input.colwise() -= mean;
    target.colwise() -= mean;
  }
  if (random.uniform() < d.rescale_share) {
    const float scale = static_cast<float>(between(random, 0.7, 1));
    input *= scale;
    target *= scale;
  }
  return input;
}

TrainingCloud training_cloud(std::uint64_t seed, std::uint64_t item, const TrainData& data,
                             const ShapeSet& shapes, const Degradation& degradation) {
  KeyedRandom random(seed, item, kStage);
  TrainingCloud cloud;
  cloud.target = clean_cloud(data, shapes, random);
  const Eigen::Matrix3f turn = random.rotation().cast<float>();
  cloud.target = (turn * cloud.target).eval();
  cloud.input = degrade(degradation, random, cloud.target);
  return cloud;
}

}  // namespace polar
