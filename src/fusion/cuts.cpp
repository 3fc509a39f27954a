#include "polar/fusion/cuts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "extent.hpp"
#include "polar/core/spiral.hpp"

namespace polar {

namespace {

constexpr int kViewDirections = 128;
constexpr double kCounted = 0.985;  // share of the points along a direction
constexpr int kSide = 32;           // of the octahedral map of the template's directions
constexpr int kOffsets = 160;
constexpr float kMost = 2.5f;       // particle radii: offsets of planes
constexpr std::size_t kPlanes = 6;  // that are followed from one translation to the others

const std::vector<Eigen::Vector3f>& directions() {
  static const std::vector<Eigen::Vector3f> all = spiral_directions<float>(kViewDirections, Spiral::sphere);
  return all;
}

// The sphere unfolded onto a square: the octahedron |x| + |y| + |z| = 1, its lower half folded outwards, and
// by the same fold back.
void fold(float& x, float& y) {
  const float folded = (1 - std::abs(y)) * std::copysign(1.0f, x);
  y = (1 - std::abs(x)) * std::copysign(1.0f, y);
  x = folded;
}

int cell_of(const Eigen::Vector3f& u) {
  const float norm = std::abs(u.x()) + std::abs(u.y()) + std::abs(u.z());
  float x = u.x() / norm, y = u.y() / norm;
  if (u.z() < 0) fold(x, y);
  const auto index = [](float a) {
    return std::min(kSide - 1, static_cast<int>((a + 1) * (0.5f * static_cast<float>(kSide))));
  };
  return index(y) * kSide + index(x);
}

Eigen::Vector3f centre_of(int cell) {
  const auto coordinate = [](int i) {
    return (static_cast<float>(i) + 0.5f) * (2.0f / static_cast<float>(kSide)) - 1;
  };
  float x = coordinate(cell % kSide), y = coordinate(cell / kSide);
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) fold(x, y);
  return Eigen::Vector3f(x, y, z).normalized();
}

constexpr float kPerUnit = static_cast<float>(kOffsets) / (2 * kMost);

int offset_of(float s) {
  return static_cast<int>(std::clamp((s + kMost) * kPerUnit, 0.0f, static_cast<float>(kOffsets) - 1));
}

}  // namespace

ViewReach reach_of(const Eigen::Matrix3Xf& points) {
  ViewReach out;
  if (points.cols() == 0) return out;
  out.farthest.reserve(kViewDirections);
  Extent extent(points);
  for (const Eigen::Vector3f& d : directions()) {
    extent.project(d);
    out.farthest.push_back(extent.quantile(kCounted));
  }
  return out;
}

CutTable::CutTable(const Mixture& mixture) : beyond_(static_cast<std::size_t>(kSide * kSide * kOffsets)) {
  for (int cell = 0; cell < kSide * kSide; ++cell) {
    float* row = &beyond_[static_cast<std::size_t>(cell * kOffsets)];
    const Eigen::RowVectorXf along = centre_of(cell).transpose() * mixture.centre;
    for (Eigen::Index k = 0; k < along.size(); ++k) row[offset_of(along[k])] += mixture.weight[k];
    // Mass beyond the middle of a bin.
    float sum = 0;
    for (int s = kOffsets - 1; s >= 0; --s) {
      const float here = row[s];
      row[s] = sum + 0.5f * here;
      sum += here;
    }
  }
}

const float* CutTable::row_of(const Eigen::Vector3f& direction) const {
  return &beyond_[static_cast<std::size_t>(cell_of(direction) * kOffsets)];
}

void CutTable::visible(const ViewReach& reach, const Eigen::Matrix3f& rotation,
                       const std::vector<Eigen::Vector3f>& translation, float* share) const {
  if (reach.farthest.empty()) {
    std::fill(share, share + translation.size(), 1.0f);
    return;
  }
  // The planes that cut most at the middle one of the translations; the others hardly cut more elsewhere.
  struct Plane {
    float beyond;
    Eigen::Vector3f normal;
    float farthest;
    const float* row;
  };
  std::array<Plane, kPlanes> most;
  for (Plane& p : most) p = {-1, Eigen::Vector3f::Zero(), 0, beyond_.data()};
  for (std::size_t d = 0; d < reach.farthest.size(); ++d) {
    const Eigen::Vector3f u = rotation * directions()[d];
    const float* row = row_of(u);
    const float beyond = row[offset_of(reach.farthest[d] + u.dot(translation[translation.size() / 2]))];
    if (beyond <= most.back().beyond) continue;
    std::size_t k = kPlanes - 1;
    for (; k > 0 && most[k - 1].beyond < beyond; --k) most[k] = most[k - 1];
    most[k] = {beyond, u, reach.farthest[d], row};
  }
  for (std::size_t t = 0; t < translation.size(); ++t) {
    float beyond = 0;
    for (const Plane& p : most)
      beyond = std::max(beyond, p.row[offset_of(p.farthest + p.normal.dot(translation[t]))]);
    share[t] = 1 - beyond;
  }
}

Cut CutTable::likeliest(const ViewReach& reach, const Pose& template_from_view) const {
  Cut out;
  const Eigen::Matrix3f rotation = template_from_view.rotation.cast<float>();
  const Eigen::Vector3f translation = template_from_view.translation.cast<float>();
  for (std::size_t d = 0; d < reach.farthest.size(); ++d) {
    const Eigen::Vector3f u = rotation * directions()[d];
    const float offset = reach.farthest[d] + u.dot(translation);
    const float visible = 1 - row_of(u)[offset_of(offset)];
    if (visible < out.visible || d == 0) out = {directions()[d], reach.farthest[d], visible};
  }
  return out;
}

float CutTable::gain(float share, std::size_t localisations) {
  return -static_cast<float>(localisations) * std::log(std::max(share, kLeastShown));
}

}  // namespace polar
