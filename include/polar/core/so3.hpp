// The rotation group: exponential, logarithm, geodesic angle, uniform sampling. Angles in radians.
#pragma once

#include <Eigen/Geometry>

namespace polar {

/// Matrix [w]_x with [w]_x v = w x v.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w);

/// Rodrigues' formula exp([w]_x); accurate for |w| -> 0.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w);

/// Inverse of so3_exp with |w| <= pi; accurate near 0 and near pi.
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);

/// Geodesic distance of two rotations, [0, pi] (the paper's relative angle; through the
/// quaternion, because arccos of the trace loses half the digits near 0).
double geodesic_angle(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// Haar-uniform rotation from three uniform numbers in [0, 1) (K. Shoemake, Uniform random
/// rotations, Graphics Gems III, 1992).
Eigen::Quaterniond haar_rotation(double u1, double u2, double u3);

/// Nearest rotation in the Frobenius norm (orthogonal Procrustes with determinant +1).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& m);

}  // namespace polar
