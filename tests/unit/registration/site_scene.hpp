#pragma once

#include "polar/core/rng.hpp"
#include "registration/rounds.hpp"

namespace polar {

// Views of twelve sites, each with its true pose and the template that belongs to them.
struct SiteScene {
  Views views;
  RoundState state;

  SiteScene() {
    state.mixture.centre = Eigen::Matrix3Xf::Zero(3, 12);
    state.mixture.weight = Eigen::VectorXf::Constant(12, 1.0f / 12);
    state.mixture.outlier_fraction = 0.05, state.mixture.outlier_density = 0.07;
    KeyedRandom place(4, 0, 1);
    for (int k = 0; k < 12; ++k) state.mixture.centre.col(k) = place.direction().cast<float>();
    const Eigen::Matrix3Xf sites = state.mixture.centre;
    sort_into_blocks(state.mixture);
    for (std::uint64_t i = 0; i < 20; ++i) {
      KeyedRandom random(4, i, 2);
      const Pose pose{random.rotation(), {0, 0, 0}};
      View view;
      view.points.resize(3, 80);
      for (Eigen::Index j = 0; j < 80; ++j) {
        Eigen::Vector3d x = sites.col(static_cast<Eigen::Index>(random.below(12))).cast<double>();
        for (int a = 0; a < 3; ++a) x[a] += 0.05 * random.normal();
        view.points.col(j) = (pose.inverse() * x).cast<float>();
      }
      view.covariance.assign(80, {0.0025f, 0, 0.0025f, 0, 0, 0.0025f});
      views.view.push_back(view);
      state.pose.push_back(pose);
    }
    state.margin.assign(20, 1);
  }
};

}  // namespace polar
