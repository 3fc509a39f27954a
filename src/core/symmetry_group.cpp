#include "polar/core/symmetry_group.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
constexpr int kMostUnits = 360;
constexpr double kSame = 1e-6;  // rad; the closest elements of the largest group are 2 pi / 360 apart

Eigen::Matrix3d turn(const Eigen::Vector3d& axis, int fold) {
  return so3_exp(2 * kPi / fold * axis.normalized());
}

// All products of the generators.
std::vector<Eigen::Matrix3d> closure(const std::vector<Eigen::Matrix3d>& generators) {
  std::vector<Eigen::Matrix3d> group = {Eigen::Matrix3d::Identity()};
  for (std::size_t i = 0; i < group.size(); ++i)
    for (const Eigen::Matrix3d& g : generators) {
      const Eigen::Matrix3d candidate = nearest_rotation(g * group[i]);
      bool known = false;
      for (const Eigen::Matrix3d& member : group) known = known || geodesic_angle(member, candidate) < kSame;
      if (!known) group.push_back(candidate);
    }
  return group;
}

int fold(const std::string& name) {
  int n = 0;
  const char* end = name.data() + name.size();
  const auto parsed = std::from_chars(name.data() + 1, end, n);
  return parsed.ec == std::errc() && parsed.ptr == end && n >= 1 && n <= kMostUnits ? n : 0;
}
}  // namespace

bool in_asymmetric_unit(const std::vector<Eigen::Matrix3d>& group, const Eigen::Matrix3f& rotation) {
  constexpr float kRounding = 1e-5f;  // of a trace
  const float own = rotation.trace();
  return std::none_of(group.begin(), group.end(), [&](const Eigen::Matrix3d& g) {
    return (g.cast<float>() * rotation).trace() > own + kRounding;
  });
}

bool is_symmetry_group(const std::string& name) {
  return name == "none" || name == "T" || name == "O" || name == "I" ||
         (name.size() > 1 && (name[0] == 'C' || name[0] == 'D') && fold(name) > 0);
}

std::vector<Eigen::Matrix3d> symmetry_rotations(const std::string& name) {
  const Eigen::Vector3d x(1, 0, 0), z(0, 0, 1), diagonal(1, 1, 1);
  const double golden = (1 + std::sqrt(5.0)) / 2;
  if (name == "none") return {Eigen::Matrix3d::Identity()};
  if (name == "T") return closure({turn(z, 2), turn(diagonal, 3)});
  if (name == "O") return closure({turn(z, 4), turn(diagonal, 3)});
  if (name == "I") return closure({turn({0, 1, golden}, 5), turn(diagonal, 3)});
  if (name.size() > 1 && (name[0] == 'C' || name[0] == 'D') && fold(name) > 0) {
    std::vector<Eigen::Matrix3d> group;
    const int n = fold(name);
    group.reserve(2 * static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) group.push_back(so3_exp(2 * kPi * i / n * z));
    if (name[0] == 'D')
      for (int i = 0; i < n; ++i) group.push_back(group[static_cast<std::size_t>(i)] * turn(x, 2));
    return group;
  }
  throw smlm::Error(smlm::Fault::usage, "symmetry", "'" + name + "' is not a rotation group",
                    "use none, C<n> or D<n> (n from 1 to 360), T, O or I");
}

}  // namespace polar
