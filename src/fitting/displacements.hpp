// Where the sites of each particle are: localisations shared out to displaced sites, by expectation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/fitting/fit_data.hpp"

namespace polar::fitting {

/// A label of one particle at one site, as far as its localisations tell.
struct Label {
  Eigen::Index site = 0;
  Eigen::Vector3d displacement_nm = Eigen::Vector3d::Zero();  // of their mean from the site's mean place
  Eigen::Matrix3d covariance_nm2 = Eigen::Matrix3d::Zero();   // of that mean, without the label's own offset
  double localisations = 0;                                   // expected
};

/// What all particles share.
struct Structure {
  Eigen::Matrix3Xd site_nm;  // means
  Eigen::VectorXd weight;    // of localisations, sum 1 - background
  double background = 0.05;
  double variance_nm2 = 4;  // of a label about its displaced site, an axis
};

/// The sites of one particle.
struct Places {
  Eigen::Matrix3Xd x_nm;
  std::vector<Eigen::Matrix3d> spread_nm2;  // covariance of what is not known of each
  Eigen::VectorXd weight;                   // of its localisations, sum 1 - background
};

/// Log densities of a particle's localisations, and who is responsible.
struct Sharing {
  Eigen::MatrixXd responsibility;  // sites x localisations
  Eigen::VectorXd log_density;
};

Sharing share_out(const FitData& data, const Places& places, double background);

/// Labels that the particle shows (at least half a localisation), displaced from the structure's mean sites.
std::vector<Label> labels_of(const FitData& data, const Structure& structure, const Sharing& sharing);

}  // namespace polar::fitting
