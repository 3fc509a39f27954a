#include "points.hpp"

#include <algorithm>

namespace polar::fitting {

namespace {
constexpr int kFewest = 4, kMost = 4000;  // of a primitive

int steps(double length_nm, double spacing_nm) {
  const double n = std::ceil(std::abs(length_nm) / spacing_nm);
  return static_cast<int>(std::clamp(n, double(kFewest), double(kMost)));
}
}  // namespace

Counts counts_for(const GeometricModel& model, const std::vector<double>& parameter, double spacing_nm) {
  Counts counts;
  for (const Part& part : model.part) {
    const auto argument = [&](std::size_t i) { return part.argument[i].at(parameter); };
    std::array<int, 2> n = {1, 1};
    const double area_nm2 = spacing_nm * spacing_nm;
    if (part.shape == Shape::line) n[0] = steps(argument(0), spacing_nm);
    if (part.shape == Shape::ring)
      n[0] = part.units > 0 ? part.units : steps(kTwoPi * argument(0), spacing_nm);
    if (part.shape == Shape::disc) n[0] = steps(kPi * argument(0) * argument(0), area_nm2);
    if (part.shape == Shape::cylinder) {
      n = {steps(kTwoPi * argument(0), spacing_nm), steps(argument(1), spacing_nm)};
      const double excess = std::sqrt(static_cast<double>(n[0]) * n[1] / kMost);
      if (excess > 1)
        for (int& count : n) count = std::max(kFewest, static_cast<int>(count / excess));
    }
    if (part.shape == Shape::cap)
      n[0] = steps(kTwoPi * argument(0) * argument(0) * (1 - std::cos(argument(1) * kRadiansPerDegree)),
                   area_nm2);
    counts.push_back(n);
  }
  return counts;
}

}  // namespace polar::fitting
