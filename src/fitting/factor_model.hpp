// Displacements of sites as a few factors, by expectation maximisation:
//   d_pk = m_k + W_k z_p + R_k r_p + e_pk,   z ~ N(0, 1), r ~ N(0, pose), e_pk ~ N(0, C_pk + v 1)
// with the measured C_pk of every label, sites missing where a particle shows none, and R_k the motion of
// site k under a small rigid motion (w, t) of the particle, which the pose may have left (factor analysis, D.
// Rubin and D. Thayer, Psychometrika 47, 69, 1982; M. Tipping and C. Bishop, J. R. Stat. Soc. B 61, 611,
// 1999).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "displacements.hpp"

namespace polar::fitting {

struct FactorModel {
  Eigen::Matrix3Xd mean_nm;          // m, 3 x K
  Eigen::MatrixXd field_nm;          // W, 3 K x modes
  Eigen::MatrixXd motion;            // R, 3 K x 6
  Eigen::VectorXd motion_precision;  // of r, 6
  double variance_nm2 = 4;           // v
};

/// Modes that a model may have at most; factors with the rigid motions. Small matrices live on the stack.
constexpr int kMostModes = 20, kMostFactors = kMostModes + 6;

/// Of one particle given its labels.
struct Factors {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostFactors, 1> mean;  // (z, r)
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostFactors, kMostFactors> covariance;
};

/// No displacement yet, and room for `modes`; rigid motions about the centre of the sites.
FactorModel rigid_model(const Eigen::Matrix3Xd& site_nm, int modes, double pose_std_deg, double pose_std_nm,
                        bool planar, double variance_nm2);

Factors factors_of(const FactorModel& model, const std::vector<Label>& labels);

/// m + W z + R r of every site, and its covariance.
Eigen::Matrix3Xd displacement_of(const FactorModel& model, const Factors& factors);
std::vector<Eigen::Matrix3d> spread_of(const FactorModel& model, const Factors& factors);

/// Improves mean, fields and variance. The fields come out free of rigid motions, orthogonal, the largest
/// first, for scores of variance 1.
void fit_factors(FactorModel& model, const std::vector<std::vector<Label>>& labels);

}  // namespace polar::fitting
