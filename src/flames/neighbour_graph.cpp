#include "polar/flames/neighbour_graph.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nanoflann.hpp>

#include "polar/core/parallel.hpp"

namespace polar {

namespace {

// Both signs of every quaternion: the nearest in R^4 among them is the nearest rotation.
struct SignedQuaternions {
  const std::vector<Eigen::Quaternionf>& grid;
  std::size_t kdtree_get_point_count() const { return 2 * grid.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t d) const {
    const float v = grid[i % grid.size()].coeffs()[static_cast<Eigen::Index>(d)];
    return i < grid.size() ? v : -v;
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, SignedQuaternions>,
                                                 SignedQuaternions, 4, std::uint32_t>;

constexpr std::size_t kBlock = 256;
constexpr char kMagic[8] = {'P', 'L', 'R', 'K', 'N', 'N', '0', '1'};  // the last two: version

struct Header {
  char magic[8];
  std::uint64_t grid_hash;
  std::int64_t nodes;
  std::int64_t degree;
  std::uint64_t content_hash;
};

std::uint64_t fnv1a(const void* data, std::size_t bytes) {
  std::uint64_t h = 14695981039346656037ULL;
  const auto* p = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < bytes; ++i) h = (h ^ p[i]) * 1099511628211ULL;
  return h;
}

Header header_of(const std::vector<Eigen::Quaternionf>& grid, const NeighbourGraph& graph) {
  Header h{};
  std::memcpy(h.magic, kMagic, sizeof kMagic);
  h.grid_hash = fnv1a(grid.data(), grid.size() * sizeof(Eigen::Quaternionf));
  h.nodes = static_cast<std::int64_t>(graph.size());
  h.degree = graph.degree;
  h.content_hash = fnv1a(graph.neighbour.data(), graph.neighbour.size() * sizeof(std::int32_t));
  return h;
}

bool load(const std::filesystem::path& path, const std::vector<Eigen::Quaternionf>& grid, int k,
          NeighbourGraph& graph) {
  std::ifstream in(path, std::ios::binary);
  Header h{};
  if (!in.read(reinterpret_cast<char*>(&h), sizeof h)) return false;
  if (h.nodes != static_cast<std::int64_t>(grid.size()) || h.degree != k) return false;
  graph.degree = k;
  graph.neighbour.resize(grid.size() * static_cast<std::size_t>(k));
  if (!in.read(reinterpret_cast<char*>(graph.neighbour.data()),
               static_cast<std::streamsize>(graph.neighbour.size() * sizeof(std::int32_t))))
    return false;
  const Header expected = header_of(grid, graph);
  return std::memcmp(&h, &expected, sizeof h) == 0;
}

void save(const std::filesystem::path& path, const std::vector<Eigen::Quaternionf>& grid,
          const NeighbourGraph& graph) {
  std::error_code ignored;
  std::filesystem::create_directories(path.parent_path(), ignored);
  const std::filesystem::path temporary = path.string() + "." + std::to_string(::getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    const Header h = header_of(grid, graph);
    out.write(reinterpret_cast<const char*>(&h), sizeof h);
    out.write(reinterpret_cast<const char*>(graph.neighbour.data()),
              static_cast<std::streamsize>(graph.neighbour.size() * sizeof(std::int32_t)));
    if (!out) {
      out.close();
      std::filesystem::remove(temporary, ignored);
      return;
    }
  }
  std::filesystem::rename(temporary, path, ignored);
}

}  // namespace

NeighbourGraph neighbour_graph(const std::vector<Eigen::Quaternionf>& grid, int k) {
  const SignedQuaternions points{grid};
  const Tree tree(4, points);
  NeighbourGraph graph;
  graph.degree = k;
  graph.neighbour.resize(grid.size() * static_cast<std::size_t>(k));
  const std::size_t wanted = static_cast<std::size_t>(k) + 1;  // the node itself comes first
  parallel_blocks(grid.size(), kBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::uint32_t> index(wanted);
    std::vector<float> distance(wanted);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t found =
          tree.knnSearch(grid[i].coeffs().data(), wanted, index.data(), distance.data());
      std::int32_t* out = graph.neighbour.data() + i * static_cast<std::size_t>(k);
      std::size_t written = 0;
      for (std::size_t j = 0; j < found && written < static_cast<std::size_t>(k); ++j) {
        const auto node = static_cast<std::int32_t>(index[j] % grid.size());
        if (node != static_cast<std::int32_t>(i)) out[written++] = node;
      }
    }
  });
  return graph;
}

NeighbourGraph cached_neighbour_graph(const std::vector<Eigen::Quaternionf>& grid, int k,
                                      const std::filesystem::path& directory) {
  NeighbourGraph graph;
  if (directory.empty()) return neighbour_graph(grid, k);
  const std::filesystem::path path =
      directory / ("rotations_" + std::to_string(grid.size()) + "_" + std::to_string(k) + ".knn");
  if (load(path, grid, k, graph)) return graph;
  graph = neighbour_graph(grid, k);
  save(path, grid, graph);
  return graph;
}

std::filesystem::path cache_directory() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
    return std::filesystem::path(xdg) / "polar-smlm";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache" / "polar-smlm";
  return {};
}

}  // namespace polar
