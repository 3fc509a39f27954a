#include "polar/fusion/orbits.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "polar/core/so3.hpp"

namespace polar {

namespace {

constexpr Eigen::Index kMostCentres = 4096;
constexpr double kGrowth = 1.25;     // of the merging distance where centres are too many
constexpr float kDead = 1e-12f;      // weight of a centre that describes nothing
constexpr double kSamePoint = 1e-4;  // particle radii; far below any uncertainty
constexpr int kMostProjections = 4;  // onto axes: each may bring another one into reach

Eigen::Index nearest(const Eigen::Matrix3Xf& points, const Eigen::Vector3f& x, Eigen::Index count) {
  Eigen::Index at = 0;
  (points.leftCols(count).colwise() - x).colwise().squaredNorm().minCoeff(&at);
  return at;
}

// For every centre the weight of the averaged mixture within `distance`.
std::vector<float> local_weight(const Mixture& m, const RotationGroup& group, double distance) {
  std::vector<float> out(static_cast<std::size_t>(m.size()), 0.0f);
  const auto d2 = static_cast<float>(distance * distance);
  for (const Eigen::Matrix3d& g : group) {
    const Eigen::Matrix3Xf image = g.cast<float>() * m.centre;
    for (Eigen::Index k = 0; k < m.size(); ++k)
      out[static_cast<std::size_t>(k)] +=
          ((image.colwise() - m.centre.col(k)).colwise().squaredNorm().transpose().array() < d2)
              .select(m.weight.array(), 0.0f)
              .sum();
  }
  return out;
}

// Whole orbits, the heaviest spot first, none nearer than `distance` to an earlier one.
Eigen::Matrix3Xf seeds(const Mixture& m, const RotationGroup& group, double distance) {
  const std::vector<float> density = local_weight(m, group, distance);
  std::vector<Eigen::Index> order(density.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return density[static_cast<std::size_t>(a)] > density[static_cast<std::size_t>(b)];
  });
  const auto most = m.size() * static_cast<Eigen::Index>(group.size());
  Eigen::Matrix3Xf seed(3, most);
  Eigen::Index count = 0;
  for (const Eigen::Index k : order) {
    const Eigen::Vector3f c = m.centre.col(k);
    if (m.weight[k] < kDead) continue;
    if (count > 0 && (seed.col(nearest(seed, c, count)) - c).norm() < static_cast<float>(distance)) continue;
    const Eigen::Vector3d x = onto_axes(c.cast<double>(), group, distance / 2);
    const Eigen::Index first = count;
    for (const Eigen::Matrix3d& g : group) {
      const Eigen::Vector3f image = (g * x).cast<float>();
      bool known = false;
      for (Eigen::Index s = first; s < count && !known; ++s)
        known = (seed.col(s) - image).norm() < static_cast<float>(kSamePoint);
      if (!known) seed.col(count++) = image;
    }
  }
  return seed.leftCols(count);
}

}  // namespace

double angle_modulo(const RotationGroup& group, const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  double least = geodesic_angle(a, b);
  for (const Eigen::Matrix3d& g : group) least = std::min(least, geodesic_angle(g * a, b));
  return least;
}

Eigen::Vector3d onto_axes(Eigen::Vector3d x, const RotationGroup& group, double distance) {
  const auto from_axis = [&](const Eigen::Matrix3d& g) {
    const Eigen::Vector3d axis = so3_log(g).normalized();  // of the identity: 0
    return (x - axis.dot(x) * axis).norm();
  };
  for (int i = 0; i < kMostProjections; ++i) {
    Eigen::Vector3d sum = x;
    double count = 1;
    for (std::size_t g = 1; g < group.size(); ++g)
      if (from_axis(group[g]) < distance) sum += group[g] * x, ++count;
    const Eigen::Vector3d mean = sum / count;
    if ((mean - x).norm() < kSamePoint) break;
    x = mean;
  }
  return x;
}

std::vector<std::vector<Eigen::Index>> orbits(const Eigen::Matrix3Xf& centre, const RotationGroup& group) {
  std::vector<std::vector<Eigen::Index>> out;
  std::vector<bool> known(static_cast<std::size_t>(centre.cols()), false);
  for (Eigen::Index k = 0; k < centre.cols(); ++k) {
    if (known[static_cast<std::size_t>(k)]) continue;
    std::vector<Eigen::Index> orbit;
    for (const Eigen::Matrix3d& g : group) {
      orbit.push_back(nearest(centre, g.cast<float>() * centre.col(k), centre.cols()));
      known[static_cast<std::size_t>(orbit.back())] = true;
    }
    out.push_back(std::move(orbit));
  }
  return out;
}

void snap_to_orbits(Mixture& mixture, const RotationGroup& group,
                    const std::vector<std::vector<Eigen::Index>>& orbits) {
  for (const auto& orbit : orbits) {
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    float weight = 0;
    for (std::size_t g = 0; g < group.size(); ++g) {
      first += group[g].transpose() * mixture.centre.col(orbit[g]).cast<double>();
      weight += mixture.weight[orbit[g]];
    }
    const auto count = static_cast<double>(group.size());
    for (std::size_t g = 0; g < group.size(); ++g) {
      mixture.centre.col(orbit[g]) = (group[g] * (first / count)).cast<float>();
      mixture.weight[orbit[g]] = weight / static_cast<float>(count);
    }
  }
}

Mixture symmetrised(const Mixture& mixture, const RotationGroup& group, double distance) {
  Mixture out = mixture;
  do {
    out.centre = seeds(mixture, group, distance);
    distance *= kGrowth;
  } while (out.size() > kMostCentres);
  const Eigen::Matrix3Xf seed = out.centre;
  const auto orbit = orbits(seed, group);
  // To the mean of what lies nearest; an image of a centre says the same about an image of the seed.
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, seed.cols());
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(seed.cols());
  for (const Eigen::Matrix3d& g : group)
    for (Eigen::Index k = 0; k < mixture.size(); ++k) {
      const Eigen::Vector3f image = g.cast<float>() * mixture.centre.col(k);
      const Eigen::Index s = nearest(seed, image, seed.cols());
      sum.col(s) += static_cast<double>(mixture.weight[k]) * image.cast<double>();
      weight[s] += static_cast<double>(mixture.weight[k]);
    }
  for (Eigen::Index s = 0; s < seed.cols(); ++s)
    if (weight[s] > 0) out.centre.col(s) = (sum.col(s) / weight[s]).cast<float>();
  out.weight = (weight / std::max(weight.sum(), 1e-30)).cast<float>();
  snap_to_orbits(out, group, orbit);
  out.weight /= std::max(out.weight.sum(), kDead);
  sort_into_blocks(out);
  return out;
}

}  // namespace polar
