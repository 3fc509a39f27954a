// What is labelled: sites or units of a symmetry, labels a particle, localisations a label and a particle.
#include <algorithm>
#include <cmath>

#include "bars.hpp"
#include "interval.hpp"
#include "plot.hpp"
#include "polar/core/median.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr double kZ = 1.959964;  // of a normal: 95 %
constexpr std::size_t kMostPlaces = 60;

// Expected numbers as bars of whole numbers, without the empty ones at the end.
std::string expected_svg(const std::vector<double>& expected, std::size_t first, const std::string& x_label,
                         const std::string& y_label) {
  std::vector<double> values;
  for (std::size_t k = first; k < expected.size(); ++k)
    values.insert(values.end(), static_cast<std::size_t>(std::lround(expected[k])), static_cast<double>(k));
  return histogram_svg(whole_number_histogram(values), x_label, y_label, "c1");
}

void add_places(const RunRecord& record, Section& s) {
  const LabellingRecord& l = *record.labelling;
  const bool units = l.of == "symmetric units";
  const std::string place = units ? "unit" : "site";
  s.notes.push_back(
      "Labelling efficiency " + percent(l.efficiency, 1) + " (" + percent(l.low, 1) + " to " +
      percent(l.high, 1) + "), of " + counted(l.occupancy.size(), units ? "symmetric unit" : "site") +
      (l.labels_per_site > 1 ? " with " + std::to_string(l.labels_per_site) + " labels each" : "") +
      ". A localisation counts for every " + place + " that could have made it, as far as it is probable.");
  s.figures.push_back({"labelled-a-particle", "Labelled " + place + "s a particle",
                       expected_svg(l.particles_with, 0, "labelled " + place + "s", "particles"),
                       "Of " + std::to_string(l.occupancy.size()) + "."});
  s.figures.push_back({"blinks", "Localisations of a label",
                       expected_svg(l.labels_of, 1, "localisations of a labelled " + place, place + "s"),
                       "Blinks, times the labels of a " + place + "."});
}

void add_occupancy(const RunRecord& record, Section& s) {
  const LabellingRecord& l = *record.labelling;
  const bool units = l.of == "symmetric units";
  const std::string place = units ? "unit" : "site";
  const auto n = static_cast<double>(accepted_particles(record));
  if (l.occupancy.size() > kMostPlaces) {
    s.figures.push_back(absent("occupancy", "Occupancy",
                               "There are more than " + std::to_string(kMostPlaces) + " " + place +
                                   "s: " + (units ? "/labelling/occupancy of results.h5" : "sites.csv") +
                                   " lists them."));
  } else {
    std::vector<Bar> bars;
    for (std::size_t k = 0; k < l.occupancy.size(); ++k) {
      const Interval i = wilson(l.occupancy[k], n);
      bars.push_back({place + " " + std::to_string(k + 1), l.occupancy[k],
                      percent(l.occupancy[k], 1) + " (" + percent(i.low) + " to " + percent(i.high) + ")",
                      i.low, i.high});
    }
    s.figures.push_back(
        {"occupancy", "Occupancy of each " + place,
         bars_svg(bars, "share of particles with a label at each " + place),
         std::string("Share of the accepted particles with a label there, with intervals of 95 % "
                     "(Wilson).") +
             (units ? " Which unit is the first is a convention of each pose." : "")});
  }
}
}  // namespace

Interval wilson(double share, double n) {
  if (!(n > 0)) return {0, 1};
  const double z2 = kZ * kZ / n, middle = (share + z2 / 2) / (1 + z2);
  const double half = kZ / (1 + z2) * std::sqrt(share * (1 - share) / n + z2 / (4 * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

Section labelling_section(const Subject& subject) {
  Section s{"labelling", "Labelling", {}, {}, {}};
  std::vector<double> counts;
  for (const PoseRow& p : subject.record.poses)
    if (p.accepted) counts.push_back(static_cast<double>(p.n_localisations));
  if (counts.empty()) {
    s.figures.push_back(absent("occupancy", "Occupancy", "No particle has a pose."));
    s.figures.push_back(absent("localisations", "Localisations a particle", "No particle has a pose."));
    return s;
  }
  const bool counted_labels = subject.record.labelling.has_value();
  if (counted_labels) add_places(subject.record, s);
  s.figures.push_back({"localisations", "Localisations a particle",
                       histogram_svg(histogram(counts), "localisations", "particles", "c1"),
                       "Median " + digits(upper_median(counts)) + "."});
  if (counted_labels)
    add_occupancy(subject.record, s);
  else
    s.figures.push_back(absent("occupancy", "Occupancy",
                               "Labels are counted on sites that can be told apart, or on the units "
                               "of a symmetry: the average has neither."));
  return s;
}

}  // namespace polar::report
