// One simulated particle, before it becomes rows of a table.
#pragma once

#include <vector>

#include "polar/simulation/simulate.hpp"

namespace polar::simulation {

struct ParticleDraw {
  Pose structure_from_view;
  double visibility = 1;
  double radius_change_nm = 0, height_change_nm = 0;
  Eigen::Matrix3Xd visible_site_nm;          // structure frame, what the crop left
  std::vector<Eigen::Vector3d> position_nm;  // table frame, noise included; structure first, outliers after
  std::vector<smlm::Covariance> covariance_nm2;
  std::size_t n_structure = 0;  // the rest are outliers
};

/// Radius (in structure radii) of the ball that uniform outliers fill.
constexpr double kOutlierBall = 1.5;

ParticleDraw draw_particle(const Structure& structure, const SimulationOptions& options, std::uint64_t index);

}  // namespace polar::simulation
