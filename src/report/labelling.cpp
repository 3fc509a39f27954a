// What is labelled: units of a symmetry, localisations a particle, localisations a labelled unit.
#include <Eigen/Core>
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
constexpr Eigen::Index kMostUnits = 60;

// Localisations of every accepted particle that are nearest to each unit.
struct UnitCounts {
  std::vector<std::vector<std::size_t>> of;  // particle x unit
};

UnitCounts count_units(const RunRecord& record) {
  const smlm::LocalisationTable& t = record.result.superparticle;
  const Eigen::Matrix3Xd& unit = record.symmetry->unit_nm;
  std::vector<std::vector<std::size_t>> all(record.poses.size(),
                                            std::vector<std::size_t>(static_cast<std::size_t>(unit.cols())));
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Eigen::Vector3d x(t.position_nm[i][0], t.position_nm[i][1], t.position_nm[i][2]);
    Eigen::Index nearest = 0;
    (unit.colwise() - x).colwise().squaredNorm().minCoeff(&nearest);
    if (t.particle[i] >= 0) ++all[static_cast<std::size_t>(t.particle[i])][static_cast<std::size_t>(nearest)];
  }
  UnitCounts counts;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (record.poses[i].accepted) counts.of.push_back(std::move(all[i]));
  return counts;
}

void add_units(const Subject& subject, Section& s) {
  const UnitCounts counts = count_units(subject.record);
  const std::size_t units = counts.of.empty() ? 0 : counts.of[0].size();
  const auto n = static_cast<double>(counts.of.size());
  std::vector<Bar> bars;
  std::vector<double> labelled, blinks;
  for (const auto& own : counts.of) {
    labelled.push_back(
        static_cast<double>(std::count_if(own.begin(), own.end(), [](std::size_t c) { return c > 0; })));
    for (const std::size_t c : own)
      if (c > 0) blinks.push_back(static_cast<double>(c));
  }
  double total = 0;
  for (std::size_t u = 0; u < units; ++u) {
    double share = 0;
    for (const auto& own : counts.of) share += own[u] > 0 ? 1 / n : 0;
    total += share / static_cast<double>(units);
    const Interval i = wilson(share, n);
    bars.push_back({"unit " + std::to_string(u + 1), share,
                    percent(share, 1) + " (" + percent(i.low) + " to " + percent(i.high) + ")", i.low,
                    i.high});
  }
  s.notes.push_back(
      std::to_string(units) + " symmetric units; in the mean " + percent(total, 1) +
      " of them hold a localisation in a particle. A localisation belongs to the nearest unit.");
  s.figures.push_back({"occupancy", "Units that hold a localisation",
                       bars_svg(bars, "share of particles that show each unit"),
                       "Share of the accepted particles, with intervals of 95 % (Wilson)."});
  s.figures.push_back(
      {"units-a-particle", "Units a particle",
       histogram_svg(whole_number_histogram(labelled), "units that hold a localisation", "particles", "c1"),
       "Of " + std::to_string(units) + "."});
  s.figures.push_back(
      {"blinks", "Localisations a unit",
       histogram_svg(whole_number_histogram(blinks), "localisations of a unit that holds any", "units", "c1"),
       "Labels of a unit times their blinks."});
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
  const auto& symmetry = subject.record.symmetry;
  if (symmetry && symmetry->unit_nm.cols() > 0 && symmetry->unit_nm.cols() <= kMostUnits && !counts.empty())
    add_units(subject, s);
  else
    s.figures.push_back(
        absent("occupancy", "Units that hold a localisation",
               !symmetry ? "Which sites or units are labelled is counted on the units of a symmetry: "
                           "registration.symmetry: detect, or the group that you know."
                         : "The average has no symmetric units to count on (" + symmetry->group + ")."));
  if (counts.empty())
    s.figures.push_back(absent("localisations", "Localisations a particle", "No particle has a pose."));
  else
    s.figures.push_back({"localisations", "Localisations a particle",
                         histogram_svg(histogram(counts), "localisations", "particles", "c1"),
                         "Median " + digits(upper_median(counts)) + "."});
  return s;
}

}  // namespace polar::report
