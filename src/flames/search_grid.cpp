#include "polar/flames/search_grid.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/symmetry_group.hpp"
#include "polar/flames/rotation_grid.hpp"

namespace polar {

namespace {
constexpr double kNeighbourShare = 256.0 / kExhaustiveRotations;  // the paper's k of its L
constexpr int kFewestNeighbours = 10;
constexpr int kPlanarNeighbours = 12;
constexpr int kWorthCaching = 4000;  // rotations; smaller graphs are built in no time
}  // namespace

Eigen::Matrix3f grid_turn(bool planar, KeyedRandom random) {
  return planar ? Eigen::Matrix3f(Eigen::Matrix3f::Identity())
                : Eigen::Matrix3f(random.rotation().cast<float>());
}

SearchGrid search_grid(int rotations, bool planar, const std::vector<Eigen::Matrix3d>& group) {
  std::vector<Eigen::Quaternionf> q = planar ? planar_rotations(rotations) : super_fibonacci(rotations);
  if (group.size() > 1)
    q.erase(std::remove_if(q.begin(), q.end(),
                           [&](const auto& r) { return !in_asymmetric_unit(group, r.toRotationMatrix()); }),
            q.end());
  const int usual =
      planar ? kPlanarNeighbours
             : std::max(kFewestNeighbours, static_cast<int>(std::lround(kNeighbourShare * rotations)));
  const int k = std::min(usual, static_cast<int>(q.size()) - 1);
  SearchGrid grid;
  grid.graph = static_cast<int>(q.size()) >= kWorthCaching ? cached_neighbour_graph(q, k, cache_directory())
                                                           : neighbour_graph(q, k);
  for (const Eigen::Quaternionf& r : q) grid.rotation.push_back(r.toRotationMatrix());
  return grid;
}

}  // namespace polar
