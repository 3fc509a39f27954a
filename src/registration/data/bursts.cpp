#include "bursts.hpp"

#include <Eigen/LU>

namespace polar {

namespace {

// More are looked at nowhere: a particle of so many places is dense, and a share of it judges well.
constexpr std::size_t kMostFirstMembers = 600;

struct FirstMember {
  Eigen::Vector3f at;
  Eigen::Matrix3f precision;  // of the difference of two localisations with this covariance
};

Eigen::Matrix3f matrix_of(const Symmetric3& c, bool planar) {
  Eigen::Matrix3f m;
  m << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  if (planar) m.row(2).setZero(), m.col(2).setZero(), m(2, 2) = 1;
  return m;
}

std::vector<int> told_apart(const Eigen::Matrix3Xf& points, const std::vector<Symmetric3>& covariance,
                            const std::vector<std::uint32_t>& order, double distance, bool planar) {
  std::vector<int> burst(covariance.size(), -1);
  std::vector<FirstMember> first;
  const auto reach = static_cast<float>(distance * distance);
  for (const std::uint32_t j : order) {
    const Eigen::Vector3f x = points.col(static_cast<Eigen::Index>(j));
    int nearest = -1;
    float least = reach;
    for (std::size_t f = 0; f < first.size(); ++f) {
      const Eigen::Vector3f d = x - first[f].at;
      const float q = d.dot(first[f].precision * d);
      if (q < least) least = q, nearest = static_cast<int>(f);
    }
    if (nearest < 0 && first.size() < kMostFirstMembers) {
      nearest = static_cast<int>(first.size());
      first.push_back({x, matrix_of(covariance[j], planar).inverse() / 2});
    }
    burst[j] = nearest;
  }
  return burst;
}

}  // namespace

std::vector<int> bursts(const View& view, const std::vector<std::uint32_t>& order, double distance,
                        bool planar) {
  return told_apart(view.points, view.covariance, order, distance, planar);
}

std::vector<int> bursts(const View& view, const Eigen::Vector3f& axis, const NoiseModel& noise,
                        const std::vector<std::uint32_t>& order, double distance) {
  NoiseModel factors;
  factors.lateral_factor = noise.lateral_factor, factors.axial_factor = noise.axial_factor;
  factors.planar = noise.planar;
  std::vector<Symmetric3> scaled;
  for (const Symmetric3& c : view.covariance) scaled.push_back(effective_covariance(c, axis, factors));
  return told_apart(view.points, scaled, order, distance, noise.planar);
}

}  // namespace polar
