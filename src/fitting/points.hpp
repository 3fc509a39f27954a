// A model as points: every primitive is sampled so densely that under the localisations' spread it is smooth.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "polar/core/constants.hpp"
#include "polar/fitting/geometric_model.hpp"

namespace polar::fitting {

template <class T>
struct WeightedPoint {
  T x, y, z, weight;
};

/// Of every part: how many points around (or in all) and how many along.
using Counts = std::vector<std::array<int, 2>>;

/// Enough for points no farther apart than `spacing_nm` at these parameters, within reason.
Counts counts_for(const GeometricModel& model, const std::vector<double>& parameter, double spacing_nm);

/// Points in the frame of the primitive, equal weights.
template <class T>
void sample_shape(const Part& part, const std::array<int, 2>& count, const std::vector<T>& parameter,
                  std::vector<WeightedPoint<T>>& out) {
  using std::cos, std::sin, std::sqrt;
  const auto argument = [&](std::size_t i) { return part.argument[i].at(parameter); };
  const auto add = [&](const T& x, const T& y, const T& z) { out.push_back({x, y, z, T(0)}); };
  const int n = count[0];
  switch (part.shape) {
    case Shape::point:
      return add(T(0), T(0), T(0));
    case Shape::line: {
      const T length = argument(0);
      for (int k = 0; k < n; ++k) add(T(0), T(0), length * ((k + 0.5) / n - 0.5));
      return;
    }
    case Shape::ring: {
      const T radius = argument(0);
      for (int k = 0; k < n; ++k)
        add(radius * std::cos(kTwoPi * k / n), radius * std::sin(kTwoPi * k / n), T(0));
      return;
    }
    case Shape::disc: {  // sunflower: equal areas
      const T radius = argument(0);
      for (int k = 0; k < n; ++k) {
        const double r = std::sqrt((k + 0.5) / n), angle = kGoldenAngle * k;
        add(radius * (r * std::cos(angle)), radius * (r * std::sin(angle)), T(0));
      }
      return;
    }
    case Shape::cylinder: {
      const T radius = argument(0), length = argument(1);
      for (int j = 0; j < count[1]; ++j)
        for (int k = 0; k < n; ++k) {
          const double angle = kTwoPi * (k + 0.5 * (j % 2)) / n;
          add(radius * std::cos(angle), radius * std::sin(angle), length * ((j + 0.5) / count[1] - 0.5));
        }
      return;
    }
    case Shape::cap: {  // spiral of equal areas from the pole, which is the origin
      const T radius = argument(0), hidden = T(1) - cos(argument(1) * kRadiansPerDegree);
      for (int k = 0; k < n; ++k) {
        const T drop = hidden * ((k + 0.5) / n);
        const T r = radius * sqrt(drop * (T(2) - drop));
        add(r * std::cos(kGoldenAngle * k), r * std::sin(kGoldenAngle * k), -radius * drop);
      }
      return;
    }
    case Shape::sites: {
      const T scale = argument(0);
      for (Eigen::Index k = 0; k < part.site_nm.cols(); ++k)
        add(scale * part.site_nm(0, k), scale * part.site_nm(1, k), scale * part.site_nm(2, k));
      return;
    }
  }
}

/// All points in the model's frame; weights sum to 1.
template <class T>
std::vector<WeightedPoint<T>> points_of(const GeometricModel& model, const Counts& counts,
                                        const std::vector<T>& parameter) {
  using std::cos, std::sin;
  constexpr double kLeastShare = 1e-9;  // a part that vanished keeps a gradient
  std::vector<WeightedPoint<T>> all;
  T total(0);
  for (std::size_t p = 0; p < model.part.size(); ++p) {
    const Part& part = model.part[p];
    const std::size_t first = all.size();
    sample_shape(part, counts[p], parameter, all);
    const auto place = [&](std::size_t i) { return part.placement[i].at(parameter); };
    const T tilt = place(3) * kRadiansPerDegree, turn = place(4) * kRadiansPerDegree;
    const T ct = cos(tilt), st = sin(tilt), cu = cos(turn), su = sin(turn);
    T share = part.share.at(parameter);
    if (!(share > T(kLeastShare))) share = T(kLeastShare);
    total += share;
    for (std::size_t k = first; k < all.size(); ++k) {
      WeightedPoint<T>& m = all[k];
      const T x = ct * m.x + st * m.z, z = ct * m.z - st * m.x;
      m = {cu * x - su * m.y + place(0), su * x + cu * m.y + place(1), z + place(2),
           share * (part.site_weight.size() > 0 ? part.site_weight[static_cast<Eigen::Index>(k - first)]
                                                : 1 / static_cast<double>(all.size() - first))};
    }
  }
  for (WeightedPoint<T>& m : all) m.weight = m.weight / total;
  return all;
}

}  // namespace polar::fitting
