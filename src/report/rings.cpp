// Structures that wind about an axis, ring by ring: where along the axis localisations gather, and each such
// layer from the top.
#include <algorithm>
#include <cmath>

#include "plot.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/median.hpp"
#include "polar/results/results.hpp"
#include "raster.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kSamples = 160, kMostVoxels = 144;
constexpr double kSmoothing = 1.0 / 40;  // of the extent: standard deviation of the profile's kernel
constexpr double kLowestPeak = 0.25;     // of the highest
constexpr double kDeepestSaddle = 0.75;  // of the lower peak: less deep, and two peaks are one layer
constexpr std::size_t kMostLayers = 6;
constexpr double kLeftOut = 0.002;

struct Profile {
  std::vector<double> at_nm, density;  // localisations per nm
};

Profile profile_of(const std::vector<double>& values) {
  const double low = quantile(values, kLeftOut), high = quantile(values, 1 - kLeftOut);
  const double width = std::max(kSmoothing * (high - low), 1e-6);
  Profile p;
  for (std::size_t i = 0; i < kSamples; ++i) {
    p.at_nm.push_back(low + (high - low) * (static_cast<double>(i) + 0.5) / kSamples);
    p.density.push_back(0);
  }
  const double step = (high - low) / kSamples, norm = 1 / (width * std::sqrt(kTwoPi));
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(4 * width / std::max(step, 1e-9)));
  for (const double v : values) {
    const auto middle = static_cast<std::ptrdiff_t>(std::floor((v - low) / std::max(step, 1e-9)));
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, middle - reach);
         i <= std::min<std::ptrdiff_t>(kSamples - 1, middle + reach); ++i) {
      const double d = (p.at_nm[static_cast<std::size_t>(i)] - v) / width;
      p.density[static_cast<std::size_t>(i)] += norm * std::exp(-0.5 * d * d);
    }
  }
  return p;
}

// Where the profile is cut: the deepest places between peaks that count as layers of their own.
std::vector<double> cuts_of(const Profile& p) {
  const double highest = *std::max_element(p.density.begin(), p.density.end());
  std::vector<std::size_t> peak;
  std::vector<double> cut;
  for (std::size_t i = 0; i < p.density.size(); ++i) {
    const bool local = (i == 0 || p.density[i] >= p.density[i - 1]) &&
                       (i + 1 == p.density.size() || p.density[i] > p.density[i + 1]);
    if (!local || p.density[i] < kLowestPeak * highest) continue;
    if (!peak.empty()) {
      const auto low = std::min_element(p.density.begin() + static_cast<std::ptrdiff_t>(peak.back()),
                                        p.density.begin() + static_cast<std::ptrdiff_t>(i));
      if (*low > kDeepestSaddle * std::min(p.density[i], p.density[peak.back()])) {
        if (p.density[i] > p.density[peak.back()]) peak.back() = i;
        continue;
      }
      cut.push_back(p.at_nm[static_cast<std::size_t>(low - p.density.begin())]);
    }
    peak.push_back(i);
  }
  return cut;
}

smlm::LocalisationTable between(const smlm::LocalisationTable& t, double low, double high) {
  std::vector<bool> wanted;
  for (const auto& x : t.position_nm) wanted.push_back(x[2] >= low && x[2] < high);
  return rows_to_draw(t, wanted);
}

std::vector<double> radii(const smlm::LocalisationTable& t) {
  std::vector<double> radius;
  for (const auto& x : t.position_nm) radius.push_back(std::hypot(x[0], x[1]));
  return radius;
}

std::string profile_svg(const Profile& p, const std::vector<double>& cuts, const std::string& x_label) {
  Plot plot({p.at_nm.front(), p.at_nm.back(), x_label},
            {0, 1.1 * *std::max_element(p.density.begin(), p.density.end()), "localisations a nm"});
  plot.line("c1", p.at_nm, p.density);
  for (const double cut : cuts) plot.vertical("cut", cut, fixed(cut, 1));
  return plot.svg(x_label + ": profile of the average");
}
}  // namespace

Section rings_section(const Subject& subject) {
  Section s{"rings", "Along its axis", {}, {}, {}};
  const smlm::LocalisationTable& t = subject.points;
  if (t.size() == 0 || t.planar || !subject.frame.axial) {
    s.figures.push_back(absent("rings", "Ring by ring",
                               t.planar ? "The data are planar: there is no axis in space."
                               : t.size() == 0
                                   ? "No particle has a pose."
                                   : "The average does not wind about an axis: its extents across the "
                                     "drawn z differ, and no symmetry axis was found."));
    return s;
  }
  std::vector<double> z;
  for (const auto& x : t.position_nm) z.push_back(x[2]);
  const Profile along = profile_of(z);
  std::vector<double> cuts = cuts_of(along);
  if (cuts.size() + 1 > kMostLayers) cuts.clear();
  const std::size_t layers = cuts.size() + 1;
  s.notes.push_back(layers > 1 ? std::to_string(layers) + " layers can be told apart along z."
                               : "One layer: no two can be told apart along z.");
  s.figures.push_back({"profile-z", "Along the axis", profile_svg(along, cuts, "z [nm]"),
                       layers > 1 ? "Dashed: where the layers below are cut." : ""});
  s.figures.push_back(
      {"profile-r", "Away from the axis", profile_svg(profile_of(radii(t)), {}, "radius [nm]"), {}});
  if (layers == 1) return s;
  RenderOptions options = subject.record.result.render;
  options.most_voxels_per_axis = kMostVoxels;
  const Volume whole = render(t, options);
  std::vector<Raster> layer;
  double brightest = 0;
  Table table{{"layer", "z from [nm]", "to [nm]", "localisations", "median radius [nm]", "median z [nm]"},
              {}};
  for (std::size_t k = 0; k < layers; ++k) {
    const double low = k == 0 ? -1e300 : cuts[k - 1], high = k + 1 == layers ? 1e300 : cuts[k];
    const smlm::LocalisationTable part = between(t, low, high);
    layer.push_back(projected(render_into(whole, part, options), kTopView));
    brightest = std::max(brightest, layer.back().largest());
    std::vector<double> height;
    for (const auto& x : part.position_nm) height.push_back(x[2]);
    table.rows.push_back({std::to_string(k + 1), k == 0 ? "" : fixed(low, 1),
                          k + 1 == layers ? "" : fixed(high, 1), std::to_string(part.size()),
                          part.size() ? fixed(quantile(radii(part), 0.5), 1) : "",
                          part.size() ? fixed(quantile(height, 0.5), 1) : ""});
  }
  for (std::size_t k = 0; k < layers; ++k)
    s.figures.push_back({"ring-" + std::to_string(k + 1),
                         "Layer " + std::to_string(k + 1) + ", seen along z",
                         picture_svg(layer[k], heat_png(layer[k], brightest), "xy",
                                     "layer " + std::to_string(k + 1) + " of the average, seen along z"),
                         {}});
  s.tables.push_back(table);
  return s;
}

}  // namespace polar::report
