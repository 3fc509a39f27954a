// The average: projections and slices, one colour a channel.
#include <algorithm>
#include <cmath>

#include "channels.hpp"
#include "raster.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kMostVoxels = 144, kMostPlanarVoxels = 480;

// The pictures of one plane: every channel by its own brightest spot.
std::string picture(const std::vector<Volume>& volumes, const std::vector<Channel>& channels,
                    const Plane& plane, std::size_t begin, std::size_t end,
                    const std::vector<double>& brightest, const std::string& label) {
  std::vector<Raster> rasters;
  std::vector<Tint> tints;
  std::vector<std::pair<std::string, std::string>> legend;
  for (std::size_t c = 0; c < volumes.size(); ++c) {
    rasters.push_back(summed(volumes[c], plane, begin, end));
    tints.push_back(channels[c].tint);
    legend.emplace_back(channels[c].style, channels[c].name);
  }
  const bool one = rasters.size() == 1;
  if (one) legend.clear();
  return picture_svg(rasters[0],
                     one ? heat_png(rasters[0], brightest[0]) : tinted_png(rasters, tints, brightest),
                     plane.name, label, legend);
}

std::vector<double> brightest_of(const std::vector<Volume>& volumes, const std::vector<Plane>& planes,
                                 bool slices) {
  std::vector<double> brightest(volumes.size(), 0.0);
  for (std::size_t c = 0; c < volumes.size(); ++c)
    for (const Plane& p : planes) {
      const std::size_t depth = volumes[c].size[p.through];
      brightest[c] = std::max(
          brightest[c],
          (slices ? summed(volumes[c], p, depth / 2, depth / 2 + 1) : projected(volumes[c], p)).largest());
    }
  return brightest;
}
}  // namespace

Section average_section(const Subject& subject) {
  Section s{"average", "The average", {}, {}, {}};
  if (subject.points.size() == 0) {
    s.figures.push_back(
        absent("projection-xy", "Projections", "No particle has a pose, so there is no average."));
    return s;
  }
  s.notes.push_back(subject.frame.sentence);
  RenderOptions options = subject.record.result.render;
  options.most_voxels_per_axis = subject.points.planar ? kMostPlanarVoxels : kMostVoxels;
  const std::vector<Channel> channels = tinted_channels(subject.points, subject.record.channel_column);
  const std::vector<Volume> volumes = volumes_of(subject.points, channels, options);
  const Volume& box = volumes.front();
  s.notes.push_back(
      "Every localisation is a Gaussian of its own uncertainty, as the run found it to be; voxels of " +
      digits(box.voxel_nm) + " nm" +
      (channels.size() > 1
           ? "; one colour a channel. Brightness is on one scale a channel for all projections, and on "
             "another for all slices."
           : "; one scale of brightness for all projections, another for all slices."));
  const std::vector<Plane> planes =
      box.planar ? std::vector<Plane>{kTopView} : std::vector<Plane>{kTopView, kFrontView, kSideView};
  const std::vector<double> whole = brightest_of(volumes, planes, false);
  for (const Plane& p : planes)
    s.figures.push_back({std::string("projection-") + p.name,
                         box.planar ? "Density" : std::string("Projection, ") + p.name,
                         picture(volumes, channels, p, 0, box.size[p.through], whole,
                                 std::string("sum of the average on the plane ") + p.name),
                         {}});
  if (box.planar) return s;
  const std::vector<double> in_slice = brightest_of(volumes, planes, true);
  for (const Plane& p : planes) {
    const std::size_t middle = box.size[p.through] / 2;
    s.figures.push_back({std::string("slice-") + p.name,
                         std::string("Slice through the middle, ") + p.name,
                         picture(volumes, channels, p, middle, middle + 1, in_slice,
                                 std::string("slice through the middle of the average, plane ") + p.name),
                         {}});
  }
  return s;
}

}  // namespace polar::report
