#include "polar/flames/search_grid.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/flames/rotation_grid.hpp"

namespace polar {

namespace {
constexpr double kNeighbourShare = 256.0 / kExhaustiveRotations;  // the paper's k of its L
constexpr int kFewestNeighbours = 10;
constexpr int kPlanarNeighbours = 12;
constexpr std::size_t kFewestOfPrior = 24;  // rotations
constexpr int kMostRotations = 1 << 20;
constexpr int kWorthCaching = 4000;  // rotations; smaller graphs are built in no time
}  // namespace

Eigen::Matrix3f grid_turn(bool planar, KeyedRandom random, const PosePrior& prior) {
  if (planar) return Eigen::Matrix3f::Identity();
  if (!prior.any()) return so3_exp({0, 0, kTwoPi * random.uniform()}).cast<float>();
  return random.rotation().cast<float>();
}

SearchGrid search_grid(int rotations, bool planar, const std::vector<Eigen::Matrix3d>& group,
                       const PosePrior& prior) {
  const auto left_out = [&](const Eigen::Quaternionf& rotation) {
    const Eigen::Matrix3f r = rotation.toRotationMatrix();
    return !prior.allows(r, group) || (group.size() > 1 && !in_asymmetric_unit(group, r));
  };
  const auto kept = [&](int of) {
    std::vector<Eigen::Quaternionf> some = planar ? planar_rotations(of) : super_fibonacci(of);
    some.erase(std::remove_if(some.begin(), some.end(), left_out), some.end());
    return some;
  };
  std::vector<Eigen::Quaternionf> q = kept(rotations);
  while (!prior.any() && q.size() < kFewestOfPrior && rotations < kMostRotations) q = kept(rotations *= 2);
  const int usual =
      planar ? kPlanarNeighbours
             : std::max(kFewestNeighbours, static_cast<int>(std::lround(kNeighbourShare * rotations)));
  const int k = std::min(usual, static_cast<int>(q.size()) - 1);
  SearchGrid grid;
  if (!planar) grid.prior = prior;
  grid.graph = static_cast<int>(q.size()) >= kWorthCaching ? cached_neighbour_graph(q, k, cache_directory())
                                                           : neighbour_graph(q, k);
  for (const Eigen::Quaternionf& r : q) grid.rotation.push_back(r.toRotationMatrix());
  return grid;
}

}  // namespace polar
