// What FLAMES searches, over whatever cost: a rotation grid with its neighbourhoods.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "polar/core/pose_prior.hpp"
#include "polar/core/rng.hpp"
#include "polar/flames/neighbour_graph.hpp"

namespace polar {

/// The paper's L, and as many turns about z for planar data.
constexpr int kExhaustiveRotations = 50000, kExhaustivePlanarRotations = 720;

struct SearchGrid {
  std::vector<Eigen::Matrix3f> rotation;
  NeighbourGraph graph;
  PosePrior prior;  // outside it there are no rotations
};

/// By which a search turns its grid, so that no two look at the same rotations; none for planar data, about
/// the view's z where tilts must stay what they are.
Eigen::Matrix3f grid_turn(bool planar, KeyedRandom random, const PosePrior& prior = {});

/// Grid of about `rotations` rotations with the neighbourhood that reaches as far as 256 of 50,000 do;
/// planar: rotations about z. Large graphs are kept in the cache directory. Of a symmetric template's poses
/// only one asymmetric unit of `group` is in it, and only what the prior allows: as dense, but smaller.
SearchGrid search_grid(int rotations, bool planar, const std::vector<Eigen::Matrix3d>& group = {},
                       const PosePrior& prior = {});

}  // namespace polar
