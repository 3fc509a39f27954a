#include "model/primitives.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "polar/core/constants.hpp"

namespace polar {

namespace {
using Eigen::Vector3d;

double between(KeyedRandom& r, double low, double high) { return low + (high - low) * r.uniform(); }

Vector3d on_circle(double radius, double angle, double z) {
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Part box(KeyedRandom& random) {
  const Vector3d h(between(random, 0.1, 1), between(random, 0.05, 1), between(random, 0.02, 0.6));
  const std::array<double, 3> area{h.y() * h.z(), h.x() * h.z(), h.x() * h.y()};
  const double total = area[0] + area[1] + area[2];
  return {8 * total, [h, area, total](KeyedRandom& r) {
            double u = r.uniform() * total;
            int face = 0;
            while (face < 2 && u > area[static_cast<std::size_t>(face)])
              u -= area[static_cast<std::size_t>(face++)];
            Vector3d p(between(r, -1, 1), between(r, -1, 1), between(r, -1, 1));
            p[face] = r.bits() & 1u ? 1 : -1;
            return Vector3d(p.cwiseProduct(h));
          }};
}

/// Frustum about z: a cylinder where both radii agree, a cone where one is 0; closed or open.
Part frustum(KeyedRandom& random) {
  const double r0 = between(random, 0.05, 0.7), kind = random.uniform();
  const double r1 = kind < 0.5 ? r0 : kind < 0.75 ? 0.0 : between(random, 0.05, 0.7);
  const double h = between(random, 0.05, 1);
  const double side = kPi * (r0 + r1) * std::hypot(2 * h, r0 - r1);
  const bool closed = random.uniform() < 0.7;
  const double cap0 = closed ? kPi * r0 * r0 : 0, cap1 = closed ? kPi * r1 * r1 : 0;
  const double total = side + cap0 + cap1;
  return {total, [=](KeyedRandom& r) {
            const double u = r.uniform() * total, v = r.uniform(), angle = 2 * kPi * r.uniform();
            if (u < cap0) return on_circle(r0 * std::sqrt(v), angle, -h);
            if (u < cap0 + cap1) return on_circle(r1 * std::sqrt(v), angle, h);
            // Uniform by area: the density along the side grows with the radius.
            const double radius = std::sqrt(r0 * r0 + v * (r1 * r1 - r0 * r0));
            const double t = r0 == r1 ? v : (radius - r0) / (r1 - r0);
            return on_circle(radius, angle, h * (2 * t - 1));
          }};
}

Part torus(KeyedRandom& random) {
  const double big = between(random, 0.2, 0.9), small = between(random, 0.01, 0.35) * big;
  const double arc = random.uniform() < 0.6 ? 2 * kPi : between(random, 0.8, 5.5);
  return {arc * 2 * kPi * big * small, [=](KeyedRandom& r) {
            double phi = 2 * kPi * r.uniform();
            while (r.uniform() * (big + small) > big + small * std::cos(phi)) phi = 2 * kPi * r.uniform();
            return on_circle(big + small * std::cos(phi), arc * r.uniform(), small * std::sin(phi));
          }};
}

Part ellipsoid(KeyedRandom& random) {
  const Vector3d axes(between(random, 0.1, 0.8), between(random, 0.1, 0.8), between(random, 0.05, 0.8));
  const double from = random.uniform() < 0.6 ? -1.0 : between(random, -0.8, 0.6);  // a dome
  const double mean = axes.mean();
  return {2 * kPi * (1 - from) * mean * mean, [=](KeyedRandom& r) {
            const double z = between(r, from, 1), rho = std::sqrt(std::max(0.0, 1 - z * z));
            return Vector3d(on_circle(rho, 2 * kPi * r.uniform(), z).cwiseProduct(axes));
          }};
}

Part disc(KeyedRandom& random) {
  const double outer = between(random, 0.2, 1), inner = random.uniform() < 0.5 ? 0 : outer * random.uniform();
  return {kPi * (outer * outer - inner * inner), [=](KeyedRandom& r) {
            const double rho = std::sqrt(inner * inner + r.uniform() * (outer * outer - inner * inner));
            return on_circle(rho, 2 * kPi * r.uniform(), 0);
          }};
}

/// Tube of `radius` around curve(t), t in [0, 1].
Part tube(std::function<Vector3d(double)> curve, double length, double radius) {
  return {2 * kPi * radius * length, [curve = std::move(curve), radius](KeyedRandom& r) {
            constexpr double kStep = 1e-3;
            const double t = r.uniform();
            const Vector3d centre = curve(t), tangent = curve(t + kStep) - centre;
            const Vector3d u = tangent.unitOrthogonal(), w = tangent.normalized().cross(u);
            const double angle = 2 * kPi * r.uniform();
            return Vector3d(centre + radius * (std::cos(angle) * u + std::sin(angle) * w));
          }};
}

Part helix(KeyedRandom& random) {
  const double big = between(random, 0.1, 0.6), turns = between(random, 1, 5), h = between(random, 0.3, 1);
  const double radius = between(random, 0.01, 0.12);
  return tube([=](double t) { return on_circle(big, 2 * kPi * turns * t, h * (2 * t - 1)); },
              std::hypot(2 * kPi * turns * big, 2 * h), radius);
}
}  // namespace

Part random_primitive(KeyedRandom& random) {
  const double kind = random.uniform();
  if (kind < 0.33) return box(random);
  if (kind < 0.58) return frustum(random);
  if (kind < 0.70) return torus(random);
  if (kind < 0.84) return ellipsoid(random);
  if (kind < 0.92) return disc(random);
  return helix(random);
}

Part random_tube(KeyedRandom& random) {
  constexpr int kWaves = 3;
  std::array<Vector3d, kWaves> sine, cosine;
  for (int k = 0; k < kWaves; ++k) {
    const double size = 0.6 / (1 + k);
    sine[static_cast<std::size_t>(k)] = Vector3d(random.normal(), random.normal(), random.normal()) * size;
    cosine[static_cast<std::size_t>(k)] = Vector3d(random.normal(), random.normal(), random.normal()) * size;
  }
  const double span = between(random, 0.3, 1);  // share of the period: closed loops at 1
  return tube(
      [=](double t) {
        Vector3d p = Vector3d::Zero();
        for (std::size_t k = 0; k < kWaves; ++k) {
          const double angle = kPi * span * static_cast<double>(k + 1) * t;
          p += std::sin(angle) * sine[k] + std::cos(angle) * cosine[k];
        }
        return p;
      },
      2.0 * span, between(random, 0.01, 0.12));
}

Part site_clusters(std::vector<Vector3d> sites, double label_size) {
  const double weight = static_cast<double>(sites.size());
  return {weight, [sites = std::move(sites), label_size](KeyedRandom& r) {
            const Vector3d& site = sites[r.below(sites.size())];
            const double x = r.normal(), y = r.normal(), z = r.normal();
            return Vector3d(site + label_size * Vector3d(x, y, z));
          }};
}

Part moved(Part part, const Eigen::Matrix3d& linear, const Vector3d& shift) {
  return {part.weight, [sample = std::move(part.sample), linear, shift](KeyedRandom& r) {
            return Vector3d(linear * sample(r) + shift);
          }};
}

}  // namespace polar
