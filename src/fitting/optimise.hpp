// The only place that calls Ceres' optimiser: parameters within bounds, placement under a normal prior.
#pragma once

#include <vector>

#include "likelihood.hpp"

namespace polar::fitting {

/// What may move: parameters of the model and the six of the placement.
struct Objective {
  const GeometricModel& model;
  const FitData& data;
  Counts counts;
  Pose data_from_model;          // about which the placement moves
  std::vector<bool> free;        // model parameters and placement
  Eigen::VectorXd prior_weight;  // of the six squares of the placement's step, 1 / variance
};

struct Optimum {
  Eigen::VectorXd theta;
  double objective = 0;  // - sum of log densities + half the prior's squares
  bool converged = false;
};

/// Quasi-Newton (BFGS) with bounded parameters as logistic functions of free ones.
Optimum optimise(const Objective& objective, const Eigen::VectorXd& start, int most_iterations);

/// Covariance of theta: the jackknife over groups in one Newton step each,
///   V = (G - 1) / G sum_g d_g d_g^T,  d_g = (H - H_g)^-1 s_g,
/// H the observed information, H_g and s_g that of a group and its score (a cluster-robust covariance that is
/// right for few groups too; A. C. Cameron and D. L. Miller, J. Human Resources 50, 317, 2015, section VI.B).
/// H^-1 where groups are no more than parameters. Zero where not `free`; NaN for parameters that the data
/// leave open.
Eigen::MatrixXd covariance_at(const Objective& objective, const Eigen::VectorXd& theta);

}  // namespace polar::fitting
