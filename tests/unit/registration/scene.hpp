// Views of a few sites with known poses: labels that are there or not, several localisations of each.
#pragma once

#include "polar/core/covariance3.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/core/view.hpp"

namespace polar {

constexpr double kSceneSigma = 0.05;  // of a localisation, particle radii

/// The orbits of `sites` random places under a group.
inline Eigen::Matrix3Xd orbit_structure(const std::string& group, int sites, std::uint64_t seed,
                                        bool planar = false) {
  KeyedRandom random(seed, 0, 1);
  const std::vector<Eigen::Matrix3d> turns = symmetry_rotations(group);
  Eigen::Matrix3Xd out(3, 0);
  for (int s = 0; s < sites; ++s) {
    Eigen::Vector3d x = (0.7 + 0.3 * random.uniform()) * random.direction();
    if (planar) x.z() = 0, x *= 0.9 / x.norm();
    for (const Eigen::Matrix3d& g : turns) {
      out.conservativeResize(3, out.cols() + 1);
      out.col(out.cols() - 1) = g * x;
    }
  }
  return out;
}

struct Scene {
  Views views;
  std::vector<Pose> pose;  // structure_from_view

  Scene(const Eigen::Matrix3Xd& sites, int count, double labelled, int blinks, std::uint64_t seed,
        bool planar = false) {
    views.planar = planar;
    const auto s2 = static_cast<float>(kSceneSigma * kSceneSigma);
    for (int i = 0; i < count; ++i) {
      KeyedRandom random(seed, static_cast<std::uint64_t>(i), 2);
      Pose p;
      p.rotation = planar ? so3_exp({0, 0, 6.28318 * random.uniform()}) : random.rotation();
      View view;
      for (Eigen::Index k = 0; k < sites.cols(); ++k) {
        if (random.uniform() >= labelled) continue;
        for (int b = 0; b < blinks; ++b) {
          Eigen::Vector3d x = p.inverse() * Eigen::Vector3d(sites.col(k));
          for (int a = 0; a < (planar ? 2 : 3); ++a) x[a] += kSceneSigma * random.normal();
          view.points.conservativeResize(3, view.points.cols() + 1);
          view.points.col(view.points.cols() - 1) = x.cast<float>();
          view.covariance.push_back(isotropic_covariance(s2));
        }
      }
      views.view.push_back(std::move(view));
      pose.push_back(p);
    }
  }
};

/// Share of the views that `found` places as the truth does, up to the common motion that suits most of them
/// and the group.
inline double share_right(const std::vector<Eigen::Matrix3d>& found, const std::vector<Pose>& truth,
                          const std::string& group, double within_rad) {
  double best = 0;
  for (std::size_t r = 0; r < std::min<std::size_t>(8, truth.size()); ++r) {
    const Eigen::Matrix3d common = found[r] * truth[r].rotation.transpose();
    double right = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      bool near = false;
      for (const Eigen::Matrix3d& g : symmetry_rotations(group))
        near = near || geodesic_angle(found[i], common * g * truth[i].rotation) < within_rad;
      right += near ? 1 : 0;
    }
    best = std::max(best, right / static_cast<double>(truth.size()));
  }
  return best;
}

}  // namespace polar
