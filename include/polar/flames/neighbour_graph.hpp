// The k-neighbourhood graph of a rotation grid, geodesic angle as the distance. It depends on the grid
// only, so it is built once and kept on disk.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace polar {

struct NeighbourGraph {
  int degree = 0;
  std::vector<std::int32_t> neighbour;  // size() x degree, nearest first, the node itself not among them

  std::size_t size() const { return degree > 0 ? neighbour.size() / static_cast<std::size_t>(degree) : 0; }
  const std::int32_t* of(std::size_t node) const {
    return neighbour.data() + node * static_cast<std::size_t>(degree);
  }
};

/// k nearest rotations of every rotation; q and -q are the same rotation. k < grid size.
NeighbourGraph neighbour_graph(const std::vector<Eigen::Quaternionf>& grid, int k);

/// The same through a file in `directory` (created when missing). A file that is damaged, of another
/// version or of another grid is rebuilt; a directory that cannot be written is no error.
NeighbourGraph cached_neighbour_graph(const std::vector<Eigen::Quaternionf>& grid, int k,
                                      const std::filesystem::path& directory);

/// Where caches go: $XDG_CACHE_HOME/polar-smlm or ~/.cache/polar-smlm, empty when neither is known.
std::filesystem::path cache_directory();

}  // namespace polar
