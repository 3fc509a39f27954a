// Fourier shells of independent halves, their control on noise, and what the threshold makes of them.
#include <algorithm>
#include <cmath>

#include "curve.hpp"
#include "plot.hpp"
#include "raster.hpp"
#include "section.hpp"
#include "text.hpp"
#include "verdict.hpp"

namespace polar::report {

namespace {
constexpr double kLowest = -0.2;
constexpr double kBeyond = 3;  // of the axis, over the frequency at which the data fall below the threshold

std::string crossing(const HalfMaps& h, const std::string& of) {
  if (!std::isfinite(h.resolution.period_nm))
    return of + ": already below the threshold in one of the first three shells, so nothing is resolved.";
  if (h.resolution.at_nyquist)
    return of + ": never falls below the threshold; the voxels end first, at " +
           digits(h.resolution.period_nm) + " nm (two voxels), which the resolution is at least.";
  return of + ": falls below the threshold at a period of " + digits(h.resolution.period_nm) + " nm.";
}

// Only up to `last`: beyond it the curve would leave the plot.
void draw(Plot& plot, const char* style, const FourierShells& shells, double last) {
  const auto end = std::upper_bound(shells.frequency_per_nm.begin(), shells.frequency_per_nm.end(), last);
  const std::vector<double> frequency(shells.frequency_per_nm.begin(), end);
  plot.line(style, frequency,
            {shells.correlation.begin(),
             shells.correlation.begin() + static_cast<std::ptrdiff_t>(frequency.size())});
}

Figure shells_figure(const ResolutionReport& r) {
  const FourierShells& data = r.data.shells;
  if (data.frequency_per_nm.empty())
    return absent("fsc", "Fourier shell correlation",
                  "One of the halves has no accepted particle: no curve.");
  std::vector<std::pair<double, std::string>> periods;
  const double crossing_per_nm = 1 / r.data.resolution.period_nm;  // NaN: none
  const double last = std::isfinite(crossing_per_nm)
                          ? std::min(data.frequency_per_nm.back(), kBeyond * crossing_per_nm)
                          : data.frequency_per_nm.back();
  for (int k = 1; k <= 4; ++k) periods.emplace_back(last * k / 4, digits(4 / (last * k), 2));
  Plot plot({0, last, "period [nm]", periods}, {kLowest, 1.05, "correlation"});
  plot.horizontal("cut", kResolutionThreshold, fixed(kResolutionThreshold, 3));
  const bool controlled = !r.noise.shells.frequency_per_nm.empty();
  if (controlled) draw(plot, "c2", r.noise.shells, last);
  draw(plot, "c1", data, last);
  if (std::isfinite(r.data.resolution.period_nm) && !r.data.resolution.at_nyquist)
    plot.vertical("cut", 1 / r.data.resolution.period_nm, digits(r.data.resolution.period_nm) + " nm");
  if (controlled)
    plot.legend({{"c1", "halves"}, {"c2", "noise"}});
  else
    plot.legend({{"c1", "halves"}});
  return {
      "fsc", "Fourier shell correlation", plot.svg("Fourier shell correlation of two halves and of noise"),
      std::string("Two halves of the particles, each registered by itself and aligned only afterwards; ") +
          (!controlled       ? "noise found no pose, so that there is no curve of it."
           : r.noise.refused ? "the control is the same made of noise, whose poses were all refused: its "
                               "curve is that of the refused ones."
                             : "the control is the same made of noise.")};
}

// The picture of one plane of a half.
Raster raster_of(const Projections& p, std::size_t plane, double pixel_nm) {
  Raster r;
  r.width = r.height = p.edge;
  r.pixel_nm = pixel_nm;
  const auto begin = p.value.begin() + static_cast<std::ptrdiff_t>(plane * p.edge * p.edge);
  r.value.assign(begin, begin + static_cast<std::ptrdiff_t>(p.edge * p.edge));
  return r;
}

// Both halves of a plane on one scale of brightness.
void add_plane(const HalfMaps& h, std::size_t plane, const std::string& id, const std::string& of,
               Section& s) {
  constexpr const char* kNames[] = {"xy", "xz", "yz"};
  const Raster rasters[] = {raster_of(h.first_projections, plane, h.voxel_nm),
                            raster_of(h.second_projections, plane, h.voxel_nm)};
  const double brightest = std::max(rasters[0].largest(), rasters[1].largest());
  const std::size_t particles[] = {h.first_particles, h.second_particles};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string half = (of.empty() ? "Half " : "half ") + std::to_string(k + 1);
    s.figures.push_back({id + std::to_string(k + 1) + "-" + kNames[plane], of + half + ", " + kNames[plane],
                         picture_svg(rasters[k], heat_png(rasters[k], brightest), kNames[plane],
                                     "half map " + std::to_string(k + 1) + " of " + of +
                                         "summed on the plane " + kNames[plane]),
                         h.refused ? "Poses that were refused." : counted(particles[k], "particle") + "."});
  }
}

void add_half_maps(const ResolutionReport& r, Section& s) {
  const std::size_t planes = r.data.first_projections.planes();
  if (planes == 0) {
    s.figures.push_back(
        absent("half-maps", "Half maps",
               r.data.shells.frequency_per_nm.empty()
                   ? "One of the halves has no accepted particle: there are no half maps."
                   : "The record does not hold their pictures: the run was of an earlier version."));
    return;
  }
  s.notes.push_back(
      "The half maps below lie in the template's frame, each plane of both on one scale of brightness.");
  for (std::size_t plane = 0; plane < std::min<std::size_t>(planes, 2); ++plane)
    add_plane(r.data, plane, "half-", "", s);
  if (r.noise.first_projections.planes() > 0)
    add_plane(r.noise, 0, "noise-half-", "Noise, ", s);
  else
    s.figures.push_back(
        absent("noise-half-maps", "Half maps of noise", "Noise found no pose to make one of."));
}
Figure curve_figure(const Subject& subject) {
  const RunRecord& record = subject.record;
  const std::string title = "Resolution against particles";
  const bool recorded = !record.curve_particles.empty();
  const ResolutionCurve curve = recorded ? ResolutionCurve{record.curve_particles, record.curve_resolution_nm}
                                         : curve_of_common_poses(subject);
  const bool any = std::any_of(curve.resolution_nm.begin(), curve.resolution_nm.end(),
                               [](double v) { return std::isfinite(v); });
  if (!any)
    return absent("resolution-curve", title,
                  "Too few particles have a pose, or none of their halves resolves anything.");
  std::vector<double> doublings;  // each step to the right has twice the particles
  std::vector<std::pair<double, std::string>> ticks;
  for (const double n : curve.particles) {
    doublings.push_back(std::log2(n));
    ticks.emplace_back(doublings.back(), fixed(n, 0));
  }
  Axis across = axis_of(doublings, "particles");
  across.ticks = ticks;
  Plot plot(across, axis_of(curve.resolution_nm, "resolution [nm]"));
  plot.line("c1", doublings, curve.resolution_nm);
  plot.dots("c1", doublings, curve.resolution_nm);
  return {
      "resolution-curve", title, plot.svg("resolution against the number of particles"),
      recorded
          ? "Still falling at its right end: more particles would resolve more."
          : "Between halves that share the poses of this run: finer than independent halves would be, so "
            "read its "
            "slope and not its height. Still falling at its right end: more particles would resolve more."};
}
}  // namespace

Section resolution_section(const Subject& subject) {
  const RunRecord& record = subject.record;
  Section s{"resolution", "Resolution", {}, {}, {}};
  if (!record.resolution) {
    s.figures.push_back(
        absent("fsc", "Fourier shell correlation",
               "No half maps were made. output.resolution: halves registers two halves of "
               "the particles independently and two of pure noise, and adds their pictures, "
               "their Fourier shell correlation, the resolution and its control here; it takes "
               "twice the time again."));
    s.figures.push_back(curve_figure(subject));
    return s;
  }
  const ResolutionReport& r = *record.resolution;
  s.notes.push_back(crossing(r.data, "The halves"));
  s.notes.push_back(r.noise.first_particles > 0 && r.noise.second_particles > 0
                        ? crossing(r.noise, "The control on noise")
                        : "The control: no particle of pure noise got a pose that was accepted, so noise "
                          "resolves nothing.");
  if (!r.supported())
    s.notes.push_back("The halves have no more in common than noise: no structure is resolved.");
  s.figures.push_back(shells_figure(r));
  s.tables.push_back(
      {{"half-maps", "particles", "voxel [nm]", "resolution [nm]"},
       {{"data", std::to_string(r.data.first_particles) + " + " + std::to_string(r.data.second_particles),
         digits(r.data.voxel_nm), resolution_text(r.data)},
        {"noise", std::to_string(r.noise.first_particles) + " + " + std::to_string(r.noise.second_particles),
         r.noise.voxel_nm > 0 ? digits(r.noise.voxel_nm) : "none", resolution_text(r.noise)}}});
  s.figures.push_back(curve_figure(subject));
  add_half_maps(r, s);
  return s;
}

}  // namespace polar::report
