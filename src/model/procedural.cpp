#include "model/procedural.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/primitives.hpp"
#include "polar/core/constants.hpp"

namespace polar {

namespace {
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Parts = std::vector<Part>;

double between(KeyedRandom& r, double low, double high) { return low + (high - low) * r.uniform(); }
int count(KeyedRandom& r, int low, int high) {
  return low + static_cast<int>(r.below(static_cast<std::uint64_t>(high - low + 1)));
}
Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix(); }

/// Parts are aligned with the axes as often as not: machines and furniture are, organelles are not.
Part placed(KeyedRandom& random, double spread) {
  Part part = random.uniform() < 0.85 ? random_primitive(random) : random_tube(random);
  Matrix3d turn = random.rotation();
  if (random.uniform() < 0.6) {
    turn.setZero();
    const int first = count(random, 0, 2), step = count(random, 1, 2);
    for (int i = 0; i < 3; ++i) turn((first + i * step) % 3, i) = 1;
  }
  const double size = between(random, 0.25, 1);
  part.weight *= size * size;
  const Vector3d shift(random.normal(), random.normal(), random.normal());
  return moved(std::move(part), size * turn, spread * shift);
}

Parts union_of(KeyedRandom& random, int low, int high) {
  Parts parts;
  const double spread = between(random, 0.1, 0.6);
  for (int i = count(random, low, high); i > 0; --i) parts.push_back(placed(random, spread));
  return parts;
}

Parts mirrored(Parts parts) {
  Matrix3d flip = Matrix3d::Identity();
  flip(0, 0) = -1;
  const std::size_t n = parts.size();
  for (std::size_t i = 0; i < n; ++i) parts.push_back(moved(parts[i], flip, Vector3d::Zero()));
  return parts;
}

Parts n_fold(const Parts& unit, int n, double radius) {
  Parts parts;
  for (int k = 0; k < n; ++k) {
    const Matrix3d turn = about_z(2 * kPi * k / n);
    for (const Part& part : unit) parts.push_back(moved(part, turn, turn * Vector3d(radius, 0, 0)));
  }
  return parts;
}

/// One to three rings of n units with one to four sites each, as nuclear pores and centrioles have.
Parts rings_of_sites(KeyedRandom& random) {
  const int n = random.uniform() < 0.5 ? 8 : count(random, 3, 13), rings = count(random, 1, 3);
  const double height = between(random, 0.1, 0.9), twist = between(random, 0, 2 * kPi / n);
  std::vector<Vector3d> unit;
  for (int i = count(random, 1, 4); i > 0; --i)
    unit.emplace_back(1 + 0.15 * random.normal(), 0.15 * random.normal(), 0.1 * random.normal());
  std::vector<Vector3d> sites;
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < n; ++k)
      for (const Vector3d& s : unit)
        sites.push_back(about_z(2 * kPi * k / n + ring * twist) * s + Vector3d(0, 0, height * ring));
  return {site_clusters(std::move(sites), between(random, 0.005, 0.06))};
}

/// Vertices of a random polyhedron, or its edges as rods.
Parts polyhedron(KeyedRandom& random) {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vector3d> v;
  switch (count(random, 0, 4)) {
    case 0:
      v = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
      break;
    case 1:
      for (int i = 0; i < 8; ++i) v.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      break;
    case 2:
      v = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
      break;
    case 3:
      for (int i = 0; i < 12; ++i) {  // icosahedron: cyclic permutations of (0, +-1, +-golden)
        Vector3d p;
        p[i / 4] = 0, p[(i / 4 + 1) % 3] = i & 1 ? 1 : -1, p[(i / 4 + 2) % 3] = i & 2 ? golden : -golden;
        v.push_back(p);
      }
      break;
    default:  // a random one
      for (int i = count(random, 4, 30); i > 0; --i) v.push_back(random.direction());
  }
  const Vector3d stretch(between(random, 0.6, 1), between(random, 0.6, 1), between(random, 0.6, 1));
  for (Vector3d& p : v) p = p.cwiseProduct(stretch);
  const double label = between(random, 0.005, 0.07);
  if (random.uniform() < 0.6) return {site_clusters(std::move(v), label)};
  double shortest = 1e9;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) shortest = std::min(shortest, (v[i] - v[j]).norm());
  Parts rods;
  for (std::size_t i = 0; i < v.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3d a = v[i], edge = v[j] - v[i];
      if (edge.norm() > 1.3 * shortest) continue;
      rods.push_back({edge.norm(), [a, edge, label](KeyedRandom& r) {
                        const double t = r.uniform(), x = r.normal(), y = r.normal(), z = r.normal();
                        return Vector3d(a + t * edge + 0.5 * label * Vector3d(x, y, z));
                      }});
    }
  return rods;
}

/// Sites on a flat rectangular grid, a random part of them occupied, as patterns on DNA origami are.
Parts flat_grid(KeyedRandom& random) {
  const int columns = count(random, 3, 12), rows = count(random, 2, 8);
  const double spacing = between(random, 0.5, 1.5), occupied = between(random, 0.3, 1);
  std::vector<Vector3d> sites = {Vector3d::Zero()};
  for (int x = 0; x < columns; ++x)
    for (int y = 0; y < rows; ++y)
      if (random.uniform() < occupied) sites.emplace_back(x, spacing * y, 0);
  return {site_clusters(std::move(sites), between(random, 0.01, 0.2))};
}

Parts structure(const TrainData& data, KeyedRandom& random) {
  const double kind = random.uniform(), solids = 1 - data.sites_share;
  if (kind >= solids) {
    // Without grids nothing is drawn for them, so that older trainings repeat to the bit.
    if (data.grid_share > 0 && random.uniform() < data.grid_share) return flat_grid(random);
    return kind < solids + data.sites_share / 2 ? rings_of_sites(random) : polyhedron(random);
  }
  const double solid = kind / solids;
  if (solid < 0.4375) return union_of(random, 1, 7);
  if (solid < 0.8125) {
    Parts parts = mirrored(union_of(random, 1, 4));
    if (random.uniform() < 0.5) parts.push_back(placed(random, 0.0));
    return parts;
  }
  return n_fold(union_of(random, 1, 2), count(random, 2, 12), between(random, 0.1, 1.5));
}
}  // namespace

void centre_and_normalise(Eigen::Matrix3Xf& cloud) {
  const Eigen::Vector3f mean = cloud.rowwise().mean();
  cloud.colwise() -= mean;
  const float radius = std::sqrt(cloud.colwise().squaredNorm().maxCoeff());
  if (radius > 0) cloud /= radius;
}

Eigen::Matrix3Xf procedural_cloud(int points, KeyedRandom& random, const TrainData& data) {
  const Parts parts = structure(data, random);
  std::vector<double> cumulative;
  double total = 0;
  for (const Part& part : parts) cumulative.push_back(total += part.weight);
  Eigen::Matrix3Xf cloud(3, points);
  for (Eigen::Index i = 0; i < points; ++i) {
    const auto at = std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * total);
    const auto chosen = std::min(static_cast<std::size_t>(at - cumulative.begin()), parts.size() - 1);
    cloud.col(i) = parts[chosen].sample(random).cast<float>();
  }
  centre_and_normalise(cloud);
  return cloud;
}

}  // namespace polar
