// The density of localisations under a placed model, and its derivatives:
//   p(x) = (1 - b) sum_k w_k N(x; R m_k + t, C_x + s^2 I) + b u
// with the model's points m_k and weights w_k, width s, background b and its density u.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "points.hpp"
#include "polar/core/pose.hpp"
#include "polar/fitting/fit_data.hpp"

namespace polar::fitting {

/// The parameters of a model followed by a step of its placement: rotation vector (rad) and shift (nm),
/// applied as data_from_model: x -> exp(w) R x + t + v.
constexpr std::size_t kPlacement = 6;
constexpr int kMostParameters = static_cast<int>(kMostModelParameters + kPlacement);

/// Points in the frame of the data, and their derivatives.
struct Density {
  Eigen::ArrayXd x, y, z, log_weight;
  double width = 0, background = 0;
  Eigen::MatrixXd jacobian;  // 4 K x parameters: all x, all y, all z, all log weights; empty: none
};

Density density_of(const GeometricModel& model, const Counts& counts, const Pose& data_from_model,
                   const Eigen::VectorXd& theta, bool derivatives);

/// Sums of log densities and of their gradients, one a group of the data (a group without localisations: 0).
struct GroupScores {
  Eigen::VectorXd log_density;  // groups
  Eigen::MatrixXd gradient;     // parameters x groups; empty without derivatives
};
GroupScores group_scores(const FitData& data, const Density& density);

/// Expected number of localisations at every point.
Eigen::VectorXd responsibilities(const FitData& data, const Density& density);

/// Log density of every localisation.
Eigen::VectorXd log_densities(const FitData& data, const Density& density);

}  // namespace polar::fitting
