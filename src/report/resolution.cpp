// Fourier shells of independent halves, their control on noise, and what the threshold makes of them.
#include <algorithm>
#include <cmath>

#include "curve.hpp"
#include "plot.hpp"
#include "section.hpp"
#include "text.hpp"
#include "verdict.hpp"

namespace polar::report {

namespace {
constexpr double kLowest = -0.2;

std::string crossing(const HalfMaps& h, const std::string& of) {
  if (!std::isfinite(h.resolution.period_nm))
    return of + ": already below the threshold in one of the first three shells, so nothing is resolved.";
  if (h.resolution.at_nyquist)
    return of + ": never falls below the threshold; the voxels end first, at " +
           digits(h.resolution.period_nm) + " nm (two voxels), which the resolution is at least.";
  return of + ": falls below the threshold at a period of " + digits(h.resolution.period_nm) + " nm.";
}

Figure shells_figure(const ResolutionReport& r) {
  const FourierShells& data = r.data.shells;
  if (data.frequency_per_nm.empty())
    return absent("fsc", "Fourier shell correlation",
                  "One of the halves has no accepted particle: no curve.");
  std::vector<std::pair<double, std::string>> periods;
  const double last = data.frequency_per_nm.back();
  for (int k = 1; k <= 4; ++k) periods.emplace_back(last * k / 4, digits(4 / (last * k), 2));
  Plot plot({0, last, "period [nm]", periods}, {kLowest, 1.05, "correlation"});
  plot.horizontal("cut", kResolutionThreshold, fixed(kResolutionThreshold, 3));
  if (!r.noise.shells.frequency_per_nm.empty())
    plot.line("c2", r.noise.shells.frequency_per_nm, r.noise.shells.correlation);
  plot.line("c1", data.frequency_per_nm, data.correlation);
  if (std::isfinite(r.data.resolution.period_nm) && !r.data.resolution.at_nyquist)
    plot.vertical("cut", 1 / r.data.resolution.period_nm, digits(r.data.resolution.period_nm) + " nm");
  plot.legend({{"c1", "halves"}, {"c2", "noise"}});
  return {"fsc", "Fourier shell correlation",
          plot.svg("Fourier shell correlation of two halves and of noise"),
          "Two halves of the particles, each registered by itself and aligned only afterwards; the control "
          "is the "
          "same made of noise."};
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
    ticks.emplace_back(doublings.back(), digits(n));
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
    s.figures.push_back(absent("fsc", "Fourier shell correlation",
                               "No half-maps were made. output.resolution: halves registers two halves of "
                               "the particles independently and "
                               "two of pure noise, and adds their Fourier shell correlation, the resolution "
                               "and its control here; it takes "
                               "twice the time again."));
    s.figures.push_back(curve_figure(subject));
    return s;
  }
  const ResolutionReport& r = *record.resolution;
  s.notes.push_back(crossing(r.data, "The halves"));
  s.notes.push_back(r.noise.first_particles > 0 && r.noise.second_particles > 0
                        ? crossing(r.noise, "The control on noise")
                        : "The control: no particle of pure noise got a pose, so noise resolves nothing.");
  if (!r.supported())
    s.notes.push_back("The halves have no more in common than noise: no structure is resolved.");
  s.figures.push_back(shells_figure(r));
  s.tables.push_back(
      {{"half-maps", "particles", "voxel [nm]", "resolution [nm]"},
       {{"data", std::to_string(r.data.first_particles) + " + " + std::to_string(r.data.second_particles),
         digits(r.data.voxel_nm), resolution_text(r.data)},
        {"noise", std::to_string(r.noise.first_particles) + " + " + std::to_string(r.noise.second_particles),
         digits(r.noise.voxel_nm), resolution_text(r.noise)}}});
  s.figures.push_back(curve_figure(subject));
  return s;
}

}  // namespace polar::report
