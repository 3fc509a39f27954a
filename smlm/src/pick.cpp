#include "smlm/pick.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "smlm/error.hpp"
#include "smlm/number_text.hpp"
#include "smlm/points.hpp"
#include "smlm/table_reader.hpp"
#include "smlm/units.hpp"
#include "text/line_reader.hpp"

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

// A ring around a pick as far as this, in radii, should hold next to nothing of its particle.
constexpr double ring = 1.25;
constexpr double most_in_ring = 0.1;  // of the pick's localisations

std::string span(const std::vector<double>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return number_text(std::round(*least)) + " to " + number_text(std::round(*most)) + " nm";
}

// "x 0 to 100 nm, y ..." of points.
template <class AllPoints>
std::string spans(const AllPoints& points) {
  std::vector<double> x, y;
  for (const auto& point : points) {
    x.push_back(point[0]);
    y.push_back(point[1]);
  }
  return "x " + span(x) + ", y " + span(y);
}

void warn_about_picks(LocalisationTable& table, const std::vector<Centre>& centres,
                      const std::vector<std::size_t>& inside, const std::vector<std::size_t>& around,
                      double radius_nm) {
  const auto empty = static_cast<std::size_t>(std::count(inside.begin(), inside.end(), 0U));
  if (!centres.empty() && empty == centres.size() && table.size() > 0) {
    throw Error(
        Fault::input, table.files.front(),
        "none of the " + std::to_string(centres.size()) + " picks holds a localisation: the centres are at " +
            spans(centres) + ", the localisations at " + spans(table.position_nm),
        "input.pick.centres and the table must be in one frame (units: input.unit, input.pixel_size_nm)");
  }
  if (empty > 0) {
    table.warnings.push_back(std::to_string(empty) + " of " + std::to_string(centres.size()) +
                             " picks hold no localisation");
  }
  std::size_t cut = 0;
  for (std::size_t i = 0; i < centres.size(); ++i)
    cut += static_cast<double>(around[i]) > most_in_ring * static_cast<double>(inside[i]) && inside[i] > 0
               ? 1U
               : 0U;
  if (10 * cut > centres.size() - empty) {
    table.warnings.push_back("in " + std::to_string(cut) + " of " + std::to_string(centres.size() - empty) +
                             " picks the localisations go on right outside the radius of " +
                             number_text(radius_nm) +
                             " nm: is it too small for the particles? (input.pick.radius_nm)");
  }
}

// The regions that Picasso's Render saves: "Centers:" with pairs of numbers, in block or flow style.
bool is_picasso_regions(const std::string& path) {
  const std::string bytes = read_head(path).bytes;
  return bytes.rfind("Centers:", 0) == 0 || bytes.find("\nCenters:") != std::string::npos;
}

std::vector<Centre> read_picasso_regions(const std::string& path) {
  LineReader lines(path);
  std::vector<double> numbers;
  bool within = false;
  for (std::string_view line; lines.next(line);) {
    const bool is_key = !line.empty() && line.front() != ' ' && line.front() != '-' && line.front() != '[' &&
                        line.front() != ']';
    if (is_key) within = line.rfind("Centers:", 0) == 0;
    if (!within) continue;
    if (is_key) line.remove_prefix(std::string_view("Centers:").size());
    while (!line.empty()) {
      const auto start = line.find_first_of("-0123456789.");
      if (start == std::string_view::npos) break;
      line.remove_prefix(start);
      double value = 0;
      const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
      if (error == std::errc()) numbers.push_back(value);
      line.remove_prefix(error == std::errc() ? static_cast<std::size_t>(end - line.data()) : 1);
    }
  }
  if (numbers.empty() || numbers.size() % 2 != 0)
    throw Error(Fault::input, path, "its Centers are not pairs of numbers", "save the pick regions again");
  std::vector<Centre> centres;
  for (std::size_t i = 0; i < numbers.size(); i += 2) centres.push_back({numbers[i], numbers[i + 1]});
  return centres;
}

void require_radius(double radius_nm) {
  if (!(radius_nm > 0 && radius_nm <= 1e9)) {
    throw Error(Fault::usage, "input.pick.radius_nm", "must be positive",
                "give the radius that just holds one particle");
  }
}

}  // namespace

std::vector<Centre> read_centres(const std::string& path, const ReadOptions& options,
                                 LocalisationTable& table) {
  // Units but pixels have round sizes.
  const bool in_pixels = units::length_of(table.position_unit_nm) == units::Length::pixel;
  ReadOptions own = options;
  own.format = "auto";
  own.columns.clear();
  if (!(own.pixel_size_nm > 0) && in_pixels) own.pixel_size_nm = table.position_unit_nm;
  if (is_picasso_regions(path)) {
    if (!(own.pixel_size_nm > 0))
      throw Error(Fault::input, path, "is in camera pixels and their size is not known",
                  "set input.pixel_size_nm");
    table.keys_used.insert("pixel_size_nm");
    std::vector<Centre> centres = read_picasso_regions(path);
    for (Centre& centre : centres) {
      for (double& value : centre) value *= own.pixel_size_nm;
    }
    return centres;
  }
  if (own.unit.empty()) own.unit = units::name(units::length_of(table.position_unit_nm));
  const Points points = read_points(path, own);
  if (points.keys_used.count("unit") > 0 && options.unit.empty()) {
    table.warnings.push_back("the centres of the picks carry no unit: taken in the table's own, " +
                             (in_pixels ? "px = " + number_text(own.pixel_size_nm) + " nm" : own.unit));
  }
  for (const char* key : {"unit", "pixel_size_nm"}) {
    if (points.keys_used.count(key) > 0) table.keys_used.insert(key);
  }
  std::vector<Centre> centres;
  for (const auto& position : points.position_nm) centres.push_back({position[0], position[1]});
  return centres;
}

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
  const Grid grid(centres, ring * radius_nm);
  table.particle_names.clear();
  table.unassigned.clear();
  for (std::size_t i = 1; i <= centres.size(); ++i) table.particle_names.push_back(std::to_string(i));
  table.particle.assign(table.size(), -1);
  std::vector<std::size_t> inside(centres.size(), 0), around(centres.size(), 0);
  for (std::size_t row = 0; row < table.size(); ++row) {
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t pick = 0;
    grid.within({table.position_nm[row][0], table.position_nm[row][1]},
                [&](std::uint32_t index, double distance) {
                  if (distance < nearest) {
                    nearest = distance;
                    pick = index;
                  }
                });
    if (nearest <= square(radius_nm)) {
      table.particle[row] = pick;
      ++inside[pick];
    } else if (std::isfinite(nearest)) {
      ++around[pick];
    }
  }
  warn_about_picks(table, centres, inside, around, radius_nm);
}

}  // namespace smlm
