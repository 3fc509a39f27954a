#include "bursts.hpp"

#include <Eigen/LU>

#include "polar/core/covariance3.hpp"

namespace polar {

namespace {

// More are looked at nowhere: a particle of so many places is dense, and a share of it judges well.
constexpr int kMostBursts = 600;
constexpr int kCentrings = 3;  // of a burst: its first member may lie at its rim

Eigen::Matrix3f matrix_of(const Symmetric3& c, bool planar) {
  Eigen::Matrix3f m = matrix3f(c);
  if (planar) m.row(2).setZero(), m.col(2).setZero(), m(2, 2) = 1;
  return m;
}

std::vector<int> told_apart(const Eigen::Matrix3Xf& points, const std::vector<Symmetric3>& covariance,
                            const std::vector<std::uint32_t>& order, double distance, bool planar) {
  std::vector<Eigen::Matrix3f> precision;
  for (const Symmetric3& c : covariance) precision.push_back(matrix_of(c, planar).inverse());
  std::vector<int> burst(covariance.size(), -1);
  std::vector<std::uint32_t> left = order, member, rest;
  const auto reach = static_cast<float>(distance * distance);
  for (int b = 0; b < kMostBursts && !left.empty(); ++b) {
    Eigen::Vector3f centre = points.col(static_cast<Eigen::Index>(left.front()));
    float variance = 2;  // of a localisation about the centre, in its own
    for (int step = 0; step <= kCentrings; ++step) {
      member.clear(), rest.clear();
      Eigen::Matrix3f total = Eigen::Matrix3f::Zero();
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const std::uint32_t j : left) {
        const Eigen::Vector3f x = points.col(static_cast<Eigen::Index>(j)), d = x - centre;
        const bool near = d.dot(precision[j] * d) < reach * variance;
        (near ? member : rest).push_back(j);
        if (near) total += precision[j], sum += precision[j] * x;
      }
      if (member.size() < 2) break;
      centre = total.inverse() * sum;
      variance = 1 + 1 / static_cast<float>(member.size());
    }
    if (member.empty()) member.push_back(left.front()), rest.assign(left.begin() + 1, left.end());
    for (const std::uint32_t j : member) burst[j] = b;
    left.swap(rest);
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
