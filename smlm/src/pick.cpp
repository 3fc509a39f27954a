#include "smlm/pick.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "smlm/error.hpp"
#include "smlm/table_reader.hpp"

namespace smlm {
namespace {

double square(double value) { return value * value; }

// Points sorted into square cells of one radius, so that a disc needs nine of them.
class Grid {
 public:
  Grid(const std::vector<Centre>& points, double radius_nm) : points_(points), radius_(radius_nm) {
    for (std::uint32_t i = 0; i < points.size(); ++i)
      entries_.push_back({cell(points[i][0]), cell(points[i][1]), i});
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(index, squared distance) for the points within the radius.
  template <class Visit>
  void within(const Centre& centre, const Visit& visit) const {
    const std::int64_t x = cell(centre[0]);
    const std::int64_t y = cell(centre[1]);
    for (std::int64_t column = x - 1; column <= x + 1; ++column) {
      const auto first = std::lower_bound(entries_.begin(), entries_.end(), Entry{column, y - 1, 0});
      for (auto it = first; it != entries_.end() && it->x == column && it->y <= y + 1; ++it) {
        const Centre& point = points_[it->index];
        const double distance = square(point[0] - centre[0]) + square(point[1] - centre[1]);
        if (distance <= square(radius_)) visit(it->index, distance);
      }
    }
  }

  /// One starting point per occupied cell: the mean of its points.
  std::vector<Centre> cell_means() const {
    std::vector<Centre> means;
    for (std::size_t first = 0; first < entries_.size();) {
      Centre sum{};
      std::size_t last = first;
      for (; last < entries_.size() && entries_[last].x == entries_[first].x &&
             entries_[last].y == entries_[first].y;
           ++last) {
        sum[0] += points_[entries_[last].index][0];
        sum[1] += points_[entries_[last].index][1];
      }
      const auto n = static_cast<double>(last - first);
      means.push_back({sum[0] / n, sum[1] / n});
      first = last;
    }
    return means;
  }

 private:
  struct Entry {
    std::int64_t x, y;
    std::uint32_t index;
    bool operator<(const Entry& other) const {
      return x != other.x ? x < other.x : y != other.y ? y < other.y : index < other.index;
    }
  };
  std::int64_t cell(double value) const { return static_cast<std::int64_t>(std::floor(value / radius_)); }

  const std::vector<Centre>& points_;
  double radius_;
  std::vector<Entry> entries_;
};

std::vector<Centre> lateral_positions(const LocalisationTable& table) {
  std::vector<Centre> points;
  points.reserve(table.size());
  for (const auto& position : table.position_nm) points.push_back({position[0], position[1]});
  return points;
}

struct Peak {
  Centre centre;
  std::size_t localisations;
};

// Moves to the mean of the points within the radius until it stays.
Peak climb(const Grid& grid, const std::vector<Centre>& points, Centre centre, double radius_nm) {
  constexpr int most_steps = 100;
  constexpr double still = 1e-4;  // of the radius
  std::size_t n = 0;
  for (int step = 0; step < most_steps; ++step) {
    Centre sum{};
    n = 0;
    const Centre before = centre;
    grid.within(centre, [&](std::uint32_t index, double) {
      ++n;
      sum[0] += points[index][0];
      sum[1] += points[index][1];
    });
    if (n == 0) break;
    centre = {sum[0] / static_cast<double>(n), sum[1] / static_cast<double>(n)};
    if (std::hypot(centre[0] - before[0], centre[1] - before[1]) < still * radius_nm) break;
  }
  return {centre, n};
}

void require_radius(double radius_nm) {
  if (!(radius_nm > 0 && radius_nm <= 1e9)) {
    throw Error(Fault::usage, "input.pick.radius_nm", "must be positive",
                "give the radius that just holds one particle");
  }
}

}  // namespace

std::vector<Centre> read_centres(const std::string& path) { return lateral_positions(read_table(path, {})); }

std::vector<Centre> find_centres(const LocalisationTable& table, const PickOptions& options) {
  require_radius(options.radius_nm);
  const std::vector<Centre> points = lateral_positions(table);
  const Grid grid(points, options.radius_nm);
  std::vector<Peak> peaks;
  for (const Centre& start : grid.cell_means()) {
    const Peak peak = climb(grid, points, start, options.radius_nm);
    if (peak.localisations >= std::max<std::size_t>(options.min_localisations, 1)) peaks.push_back(peak);
  }
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) {
    return a.localisations != b.localisations ? a.localisations > b.localisations : a.centre < b.centre;
  });
  // A grid over the peaks finds the denser neighbours within two radii.
  std::vector<Centre> candidates;
  candidates.reserve(peaks.size());
  for (const Peak& peak : peaks) candidates.push_back(peak.centre);
  const Grid neighbours(candidates, 2 * options.radius_nm);
  std::vector<bool> kept(peaks.size(), false);
  std::vector<Centre> centres;
  for (std::uint32_t i = 0; i < peaks.size(); ++i) {
    bool overlaps = false;
    neighbours.within(candidates[i],
                      [&](std::uint32_t other, double) { overlaps = overlaps || kept[other]; });
    kept[i] = !overlaps;
    if (!overlaps) centres.push_back(candidates[i]);
  }
  std::sort(centres.begin(), centres.end());
  return centres;
}

void pick_particles(LocalisationTable& table, const std::vector<Centre>& centres, double radius_nm) {
  require_radius(radius_nm);
  const Grid grid(centres, radius_nm);
  table.particle_names.clear();
  for (std::size_t i = 1; i <= centres.size(); ++i) table.particle_names.push_back(std::to_string(i));
  table.particle.assign(table.size(), -1);
  for (std::size_t row = 0; row < table.size(); ++row) {
    double nearest = std::numeric_limits<double>::infinity();
    grid.within({table.position_nm[row][0], table.position_nm[row][1]},
                [&](std::uint32_t index, double distance) {
                  if (distance < nearest) {
                    nearest = distance;
                    table.particle[row] = index;
                  }
                });
  }
}

}  // namespace smlm
