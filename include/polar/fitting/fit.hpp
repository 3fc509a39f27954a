// Maximum likelihood of a geometric model, with standard errors that know that blinks are not independent.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fitting/fit_data.hpp"
#include "polar/fitting/geometric_model.hpp"

namespace polar::fitting {

struct FitOptions {
  std::uint64_t seed = 1;
  int starts = 24;          // orientations to start from where the placement is not known
  bool free_pose = true;    // of particles that have a pose: whether it may give way
  double pose_std_deg = 5;  // by how much, standard deviation
  double pose_std_nm = 5;
  double burst_distance = 3.4;  // Mahalanobis: localisations nearer than this may be of one label
  int most_for_starts = 600;    // localisations that choose among starts
};

/// One sentence per fault, empty when the options can be used.
std::vector<std::string> violations(const FitOptions& options);

/// What came out for one set of localisations.
struct ModelFit {
  Eigen::VectorXd value;       // of the model's parameters, in their order
  Eigen::MatrixXd covariance;  // of them; 0 where held or at a bound, NaN where the data do not tell
  std::vector<bool> held, at_bound;
  Eigen::VectorXd derived, derived_std;  // of the model's derived quantities
  Pose data_from_model;
  double log_density = 0;  // mean a localisation, ln nm^-3 (planar nm^-2)
  int localisations = 0, groups = 0;
  bool converged = false;
  std::string reason = "never fitted";  // why there is no fit; empty: there is

  double std_error(std::size_t parameter) const;
};

/// Where the placement is not known: from many orientations and all starts of the parameters, the best.
ModelFit fit_from_starts(const GeometricModel& model, const FitData& data, const FitOptions& options);

/// Near a fit that is known, whose placement is held (`free_pose` false) or may give way by a normal prior.
/// Parameters that are `shared` keep the value of `near`.
ModelFit fit_near(const GeometricModel& model, const FitData& data, const ModelFit& near,
                  const FitOptions& options);

/// Mean log density a localisation of other data under a fit.
double mean_log_density(const GeometricModel& model, const FitData& data, const ModelFit& fit);

/// The fitted model as points in the frame of the data with weights that sum to 1, as densely as `data`
/// needs.
struct ModelPoints {
  Eigen::Matrix3Xd x_nm;
  Eigen::VectorXd weight;
};
ModelPoints points_of_fit(const GeometricModel& model, const FitData& data, const ModelFit& fit);

}  // namespace polar::fitting
