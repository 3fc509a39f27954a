// Is the geometry enough? A model against the template that needs none, by localisations that were not
// fitted.
#pragma once

#include <string>
#include <vector>

#include "polar/fitting/fit.hpp"

namespace polar::fitting {

/// What is known of the structure without a model: centres of a mixture in the frame of the data.
struct FreeTemplate {
  Eigen::Matrix3Xd centre_nm;
  Eigen::VectorXd weight;  // sum 1
  double width_nm = 0;
};

/// Mean of paired differences over particles and its standard error, nat a localisation.
struct Gain {
  double gain = 0, standard_error = 0;
  int particles = 0;
};

/// Mean log density per localisation that was not fitted, one a particle (NaN: too few localisations).
struct ModelEvidence {
  std::vector<double> common;  // one geometry for all particles
  std::vector<double> own;     // every particle its own parameters
  std::vector<double> free;    // the free template; empty without one
  Gain own_over_common, free_over_common;
};

/// The particles are split into two halves; common parameters, and the weights and width of the free
/// template, are those of the other half. Of each particle whole bursts (kJudging of its localisations)
/// judge; its pose, and its own parameters, come from the others, under every hypothesis likewise. The
/// centres of the free template and all poses have seen the localisations before: where that helps, it helps
/// the free template.
ModelEvidence judge_model(const GeometricModel& model, const std::vector<FitData>& particles,
                          const ModelFit& all, const FreeTemplate* free, const FitOptions& options);

}  // namespace polar::fitting
