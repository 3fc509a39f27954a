// Single particles over the outline of the average: the best, those in the middle, the worst, and rejected
// ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "contour.hpp"
#include "drawing.hpp"
#include "polar/core/median.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
using Point = std::array<double, 3>;

constexpr std::size_t kEach = 4, kMostRejected = 8, kMostDots = 500;
constexpr double kWhole = 300;     // units: one view, or two side by side, so that letters are of one size
constexpr double kOutline = 0.18;  // of the brightest spot
constexpr std::size_t kOutlineVoxels = 48;
constexpr double kHeld = 0.95;  // of a rejected particle's localisations that its tile holds

// What all tiles share: a scale, and the outlines of the average from the top and from the front.
struct Frame {
  int views = 2;
  double half_nm = 1;
  Path outline{};

  double edge() const { return kWhole / views; }
  double across(double nm, int view) const {
    return edge() * view + (edge() - 2) / 2 * (1 + std::clamp(nm / half_nm, -1.0, 1.0));
  }
  double up(double nm) const { return edge() / 2 * (1 - std::clamp(nm / half_nm, -1.0, 1.0)); }
};

Frame frame_of(const Subject& subject) {
  Frame f;
  const bool planar = subject.points.planar;
  f.views = planar ? 1 : 2;
  RenderOptions options = subject.record.result.render;
  options.most_voxels_per_axis = kOutlineVoxels;
  const Volume volume = render(subject.points, options);
  for (std::size_t axis = 0; axis < (planar ? 2u : 3u); ++axis) {
    const double last = volume.origin_nm[axis] + volume.voxel_nm * static_cast<double>(volume.size[axis] - 1);
    f.half_nm = std::max({f.half_nm, std::abs(volume.origin_nm[axis]), std::abs(last)});
  }
  for (int v = 0; v < f.views; ++v) {
    const Raster r = projected(volume, v == 0 ? kTopView : kFrontView);
    for (const auto& s : contour(r, kOutline * r.largest()))
      f.outline.move(f.across(s[0], v), f.up(s[1])).line(f.across(s[2], v), f.up(s[3]));
  }
  return f;
}

std::string tile_svg(const std::vector<Point>& points, const Frame& f, const std::string& label) {
  Drawing drawing(kWhole, f.edge());
  for (int v = 0; v < f.views; ++v) drawing.rect("tile", f.edge() * v, 0, f.edge() - 2, f.edge());
  drawing.path("outline", f.outline);
  Path dots;
  const std::size_t stride = points.size() / kMostDots + 1;
  for (std::size_t i = 0; i < points.size(); i += stride)
    for (int v = 0; v < f.views; ++v) dots.dot(f.across(points[i][0], v), f.up(points[i][v == 0 ? 1 : 2]));
  drawing.path("dots small c1", dots);
  for (int v = 0; v < f.views; ++v) drawing.text("tick", f.edge() * v + 4, 12, v == 0 ? "xy" : "xz");
  return drawing.svg(label);
}

// As imaged: about its middle, at a scale of its own where it is larger than the average.
std::string rejected_svg(std::vector<Point> points, bool planar, double half_nm, const std::string& label) {
  Frame f;
  f.views = planar ? 1 : 2;
  f.half_nm = half_nm;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> along;
    for (const Point& p : points) along.push_back(p[axis]);
    const double middle = quantile(along, 0.5);
    for (double& v : along) v = std::abs(v - middle);
    if (axis < (planar ? 2u : 3u)) f.half_nm = std::max(f.half_nm, 1.1 * quantile(along, kHeld));
    for (Point& p : points) p[axis] -= middle;
  }
  return tile_svg(points, f, label);
}

std::vector<std::size_t> ranked(const RunRecord& record) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < record.poses.size(); ++i)
    if (record.poses[i].accepted) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return record.poses[a].log_likelihood > record.poses[b].log_likelihood;
  });
  return order;
}

template <class Points>
std::map<std::int64_t, std::vector<Point>> by_particle(const std::vector<std::int64_t>& particle,
                                                       const Points& position) {
  std::map<std::int64_t, std::vector<Point>> of;
  for (std::size_t i = 0; i < particle.size(); ++i) of[particle[i]].push_back(position[i]);
  return of;
}

void add_accepted(const Subject& subject, Section& s, double& half_nm) {
  const std::vector<std::size_t> order = ranked(subject.record);
  if (order.empty()) {
    s.figures.push_back(absent("gallery-accepted", "Accepted particles", "No particle was accepted."));
    return;
  }
  s.notes.push_back(
      "By log likelihood, each aligned, its localisations over the outline of the average (at " +
      percent(kOutline) + " of its brightest spot).");
  const Frame frame = frame_of(subject);
  half_nm = frame.half_nm;
  const auto points = by_particle(subject.points.particle, subject.points.position_nm);
  const std::size_t n = order.size(), each = std::min(kEach, n);
  std::map<std::size_t, std::string> shown;  // rank -> what it stands for; few particles are shown once
  for (std::size_t k = 0; k < each; ++k) shown.emplace(k, "Best");
  for (std::size_t k = 0; k < each; ++k) shown.emplace(n - each + k, "Worst");
  for (std::size_t k = 0; k < each && n > each; ++k) shown.emplace((n - each) / 2 + k, "Middle");
  for (const auto& [rank, kind] : shown) {
    const PoseRow& p = subject.record.poses[order[rank]];
    const auto own = points.find(static_cast<std::int64_t>(order[rank]));
    if (own == points.end()) continue;
    s.figures.push_back(
        {"gallery-" + std::to_string(rank + 1), kind + ": " + p.particle,
         tile_svg(own->second, frame, "particle " + p.particle + " over the outline of the average"),
         "Rank " + std::to_string(rank + 1) + " of " + std::to_string(n) + ", log likelihood " +
             digits(p.log_likelihood) + ", " + counted(own->second.size(), "localisation") + "."});
  }
}

void add_rejected(const Subject& subject, Section& s, double half_nm) {
  const RunRecord& record = subject.record;
  std::size_t rejected = 0;
  for (const PoseRow& p : record.poses) rejected += p.accepted ? 0 : 1;
  if (rejected == 0) {
    s.figures.push_back(absent("gallery-rejected", "Rejected particles", "No particle was rejected."));
    return;
  }
  const auto points = by_particle(record.rejected_particle, record.rejected_position);
  if (points.empty()) {
    s.figures.push_back(absent("gallery-rejected", "Rejected particles",
                               "The record does not hold the localisations of rejected particles."));
    return;
  }
  // Each reason in turn, so that a frequent one does not hide the others.
  std::map<std::string, std::vector<std::size_t>> of;
  for (const auto& [i, own] : points)
    of[record.poses[static_cast<std::size_t>(i)].reason].push_back(static_cast<std::size_t>(i));
  std::vector<std::size_t> shown;
  for (std::size_t turn = 0; shown.size() < kMostRejected && turn < kMostRejected; ++turn)
    for (const auto& [reason, members] : of)
      if (turn < members.size() && shown.size() < kMostRejected) shown.push_back(members[turn]);
  for (const std::size_t i : shown) {
    const PoseRow& p = record.poses[i];
    s.figures.push_back({"rejected-" + std::to_string(i + 1), "Rejected: " + p.particle,
                         rejected_svg(points.at(static_cast<std::int64_t>(i)), subject.points.planar, half_nm,
                                      "rejected particle " + p.particle + " as imaged"),
                         "As imaged, since it has no pose: " + p.reason + "."});
  }
}
}  // namespace

Section gallery_section(const Subject& subject) {
  Section s{"gallery", "Particles", {}, {}, {}, true};
  double half_nm = 1;
  add_accepted(subject, s, half_nm);
  add_rejected(subject, s, half_nm);
  return s;
}

}  // namespace polar::report
