// Uniform samplings of the rotation group.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace polar {

/// `count` rotations spread evenly over SO(3) (M. Alexa, Super-Fibonacci spirals: fast, low-discrepancy
/// sampling of SO(3), CVPR 2022); the paper's SO(3)_L.
std::vector<Eigen::Quaternionf> super_fibonacci(int count);

/// `count` rotations about z, evenly spaced: the grid of planar data.
std::vector<Eigen::Quaternionf> planar_rotations(int count);

}  // namespace polar
