#include "particle_numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace smlm {

Summary summarise(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }),
               values.end());
  if (values.empty()) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  const double median = *middle;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return {*least, median, *most};
}

std::vector<double> sigmas_nm(const LocalisationTable& table, bool axial, std::size_t step) {
  std::vector<double> values;
  values.reserve(table.size() / step + 1);
  for (std::size_t row = 0; row < table.size(); row += step) {
    const Covariance& c = table.covariance_nm2[row];
    values.push_back(std::sqrt(axial ? static_cast<double>(c[5])
                                     : (static_cast<double>(c[0]) + static_cast<double>(c[3])) / 2));
  }
  return values;
}

ParticleNumbers measure_particles(const LocalisationTable& table) {
  struct Sums {
    double n = 0;
    std::array<double, 3> mean{}, square{};  // Welford's
    std::uint32_t file = 0;
  };
  std::vector<Sums> sums(table.particle_names.size());
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (table.particle[row] < 0) continue;
    Sums& s = sums[static_cast<std::size_t>(table.particle[row])];
    if (s.n == 0) s.file = table.source_file[row];
    s.n += 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = table.position_nm[row][axis] - s.mean[axis];
      s.mean[axis] += step / s.n;
      s.square[axis] += step * (table.position_nm[row][axis] - s.mean[axis]);
    }
  }
  ParticleNumbers numbers;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Sums& s = sums[i];
    if (s.n == 0) continue;
    const double unknown = s.n > 1 ? 1 : std::numeric_limits<double>::quiet_NaN();
    numbers.particle.push_back(i);
    numbers.localisations.push_back(s.n);
    numbers.radius_nm.push_back(unknown * std::sqrt((s.square[0] + s.square[1] + s.square[2]) / s.n));
    numbers.lateral_nm.push_back(unknown * std::sqrt((s.square[0] + s.square[1]) / (2 * s.n)));
    numbers.axial_nm.push_back(unknown * std::sqrt(s.square[2] / s.n));
    numbers.file.push_back(s.file);
  }
  return numbers;
}

}  // namespace smlm
