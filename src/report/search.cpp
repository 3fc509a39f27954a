// How the poses were found: competing starts, rounds, time.
#include <algorithm>
#include <cmath>

#include "bars.hpp"
#include "plot.hpp"
#include "section.hpp"
#include "text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kMostStarts = 24, kMostStages = 24;

Bar start_bar(const StartRecord& start, double value, double error) {
  return {start.name + (start.won ? " (won)" : ""),
          value,
          fixed(value, 4) + (error > 0 ? " ± " + fixed(error, 4) : ""),  // the first has none before it
          value - error,
          value + error,
          start.won ? "c2" : "c1"};
}

void add_starts(const RunRecord& record, Section& s) {
  if (record.starts.empty()) {
    s.figures.push_back(absent("starts", "Starts", "No starts competed: the poses were given."));
    return;
  }
  std::vector<Bar> bars;
  bool errors = false;
  for (std::size_t i = 0; i < std::min(record.starts.size(), kMostStarts); ++i) {
    const StartRecord& start = record.starts[i];
    bars.push_back(start_bar(start, start.held_out, start.held_out_std));
    errors = errors || std::isfinite(start.held_out_std);
  }
  const std::string note =
      errors ? "Held-out log likelihood a localisation, with the standard error of its difference to the "
               "best before."
             : "Held-out log likelihood a localisation. The record holds no standard errors: small "
               "differences may be chance.";
  s.figures.push_back({"starts", "Starts and proposals",
                       bars_svg(bars, "held-out log likelihood of the starts", false), note});
}

void add_rounds(const RunRecord& record, Section& s) {
  if (record.history.empty()) {
    s.figures.push_back(
        absent("rounds", "Round by round", "The record does not hold what moved or escaped in each round."));
    return;
  }
  std::vector<double> round, width, moved, escaped, held_out;
  for (const RoundRecord& r : record.history) {
    round.push_back(static_cast<double>(round.size() + 1));
    width.push_back(r.width_nm);
    moved.push_back(r.moved), escaped.push_back(r.escaped);
    held_out.push_back(r.held_out);
  }
  Axis across = axis_of(round, "round");
  for (const double n : round) across.ticks.push_back({n, fixed(n, 0)});
  std::vector<double> both = moved;
  both.insert(both.end(), escaped.begin(), escaped.end());
  Axis up = axis_of(both, "particles");
  up.low = 0;
  Plot plot(across, up);
  plot.line("c1", round, moved), plot.dots("c1", round, moved);
  plot.line("c2", round, escaped), plot.dots("c2", round, escaped);
  plot.legend({{"c1", "moved"}, {"c2", "escaped"}});
  s.figures.push_back({"rounds", "Round by round", plot.svg("particles that moved and escaped in each round"),
                       "Moved: turned by more than 2 degrees. Escaped: found more than 15 degrees away, at a "
                       "pose that explains the particle better, in the rounds that searched."});
  Plot score(across, axis_of(held_out, "held-out log likelihood"));
  score.line("c1", round, held_out), score.dots("c1", round, held_out);
  s.figures.push_back(
      {"rounds-score", "What each round gained", score.svg("held-out log likelihood of each round"),
       "Of localisations that were not fitted, nat each. The average was drawn with a width of " +
           fixed(width.front(), 2) + " nm in the first round and of " + fixed(width.back(), 2) +
           " nm in the last."});
}

void add_time(const RunRecord& record, Section& s) {
  std::vector<Bar> bars;
  double total = 0;
  for (std::size_t i = 0; i < record.stage.size(); ++i) {
    total += record.stage_seconds[i];
    bars.push_back({record.stage[i], record.stage_seconds[i], duration(record.stage_seconds[i])});
  }
  if (bars.size() > kMostStages) bars.resize(kMostStages);
  if (bars.empty())
    s.figures.push_back(absent("time", "Time", "The record holds no times."));
  else
    s.figures.push_back(
        {"time", "Time", bars_svg(bars, "seconds a stage"), duration(total) + " in all stages."});
}
}  // namespace

Section search_section(const Subject& subject) {
  const RunRecord& record = subject.record;
  Section s{"search", "How it was found", {}, {}, {}};
  const int searches = std::max(0, record.rounds);
  s.notes.push_back(std::to_string(searches) + (searches == 1 ? " search" : " searches") +
                    " for better poses of all particles" +
                    (record.history.empty() ? "" : " in " + counted(record.history.size(), "round")) +
                    (record.converged ? ", converged: " : ", not converged: ") + record.stopped_because +
                    ".");
  if (record.starts.size() > 1)
    s.notes.push_back(
        record.agreement > 0
            ? "The two best starts pose " + percent(record.agreement, 1) +
                  " of the particles alike, but for one turn that all have in common. Near 100 %: searches "
                  "from different beginnings came to one answer. A symmetric structure lowers it, since a "
                  "particle then has several poses that are the same."
            : "The record does not hold how many particles the best starts pose alike.");
  add_starts(record, s);
  add_rounds(record, s);
  add_time(record, s);
  if (record.symmetry && !record.symmetry->tried_group.empty()) {
    const SymmetryRecord& y = *record.symmetry;
    std::vector<Bar> bars;
    for (std::size_t i = 0; i < y.tried_group.size(); ++i)
      bars.push_back({y.tried_group[i] + (y.tried_group[i] == y.group ? " (taken)" : ""), y.tried_gain[i],
                      fixed(y.tried_gain[i], 4) + " ± " + fixed(y.tried_gain_std[i], 4),
                      y.tried_gain[i] - y.tried_gain_std[i], y.tried_gain[i] + y.tried_gain_std[i],
                      y.tried_group[i] == y.group ? "c2" : "c1"});
    s.figures.push_back(
        {"symmetry", "Groups that were tried", bars_svg(bars, "held-out gain of every symmetry group", false),
         "Held-out log likelihood a localisation above that without a group, with standard errors."});
  }
  return s;
}

}  // namespace polar::report
