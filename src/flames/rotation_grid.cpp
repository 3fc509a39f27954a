#include "polar/flames/rotation_grid.hpp"

#include <cmath>

#include "polar/core/constants.hpp"

namespace polar {

namespace {
constexpr double kPhi = 1.41421356237309504880;         // sqrt(2)
constexpr double kPsi = 1.533751168755204288118041413;  // real root of psi^4 = psi + 4 (Alexa 2022)
}  // namespace

std::vector<Eigen::Quaternionf> super_fibonacci(int count) {
  std::vector<Eigen::Quaternionf> grid;
  grid.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double s = i + 0.5, t = s / count, d = 2 * kPi * s;
    const double r = std::sqrt(t), big_r = std::sqrt(1 - t);
    const Eigen::Quaterniond q(big_r * std::cos(d / kPsi), r * std::sin(d / kPhi), r * std::cos(d / kPhi),
                               big_r * std::sin(d / kPsi));
    grid.push_back(q.cast<float>());
  }
  return grid;
}

std::vector<Eigen::Quaternionf> planar_rotations(int count) {
  std::vector<Eigen::Quaternionf> grid;
  grid.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double half = kPi * i / count;
    grid.push_back(Eigen::Quaterniond(std::cos(half), 0, 0, std::sin(half)).cast<float>());
  }
  return grid;
}

}  // namespace polar
