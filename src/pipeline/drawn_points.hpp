// Points with weights as a table that the renderer draws: a model beside the data.
#pragma once

#include <Eigen/Core>

#include "smlm/localisation_table.hpp"

namespace polar::pipeline {

/// Points drawn as localisations that are as uncertain as the best median axis of `like`, and wider by
/// `width_nm`, as often as they weigh (weights sum 1).
smlm::LocalisationTable drawn_points(const Eigen::Matrix3Xd& x_nm, const Eigen::VectorXd& weight,
                                     double width_nm, const smlm::LocalisationTable& like);

}  // namespace polar::pipeline
