#include "starts.hpp"

#include <algorithm>

namespace polar {

namespace {

constexpr int kFewestRandom = 3, kMostRandom = 12;
constexpr double kLookUpBudget =
    3.0e9;  // over all random starts: seconds on two cores, whatever the size of the set
constexpr int kFirstCentres = 160;

// Random starts are many where they are cheap, which is where localisations are few and a start often fails.
int random_starts(const StartContext& context, const AnnealingOptions& options) {
  double localisations = 0;
  for (const int i : context.which)
    localisations += static_cast<double>(context.fitted[static_cast<std::size_t>(i)].size());
  const double look_ups = localisations * options.rotations * 7.0 * options.sweeps;
  return std::clamp(static_cast<int>(kLookUpBudget / std::max(1.0, look_ups)), kFewestRandom, kMostRandom);
}

void best_first(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.held_out > b.held_out; });
}

}  // namespace

StartsOutcome compete(const Problem& problem, const std::vector<std::string>& starts, Progress& progress) {
  const StartContext context = start_context(problem);
  AnnealingOptions options;
  std::vector<Hypothesis> hypotheses;
  const bool random = std::find(starts.begin(), starts.end(), "random") != starts.end();
  const bool imaged = std::find(starts.begin(), starts.end(), "imaged") != starts.end();
  const int n = random ? random_starts(context, options) : 0;
  const int total = n + (imaged ? 1 : 0);
  for (int k = 0; k < n && !progress.cancelled(); ++k) {
    hypotheses.push_back(random_start(context, kFirstCentres, k));
    anneal(context, options, false, hypotheses.back());
    progress.step("starts", k + 1, total);
  }
  if (imaged && !progress.cancelled()) {
    hypotheses.push_back(imaged_start(context, kFirstCentres, n));
    AnnealingOptions gentle = options;  // the poses are meant to be near: begin narrower and colder
    gentle.first_width = 0.2;
    gentle.first_beta = 1;
    gentle.sweeps = options.sweeps / 2;
    anneal(context, gentle, true, hypotheses.back());
    progress.step("starts", total, total);
  }
  StartsOutcome out;
  out.which = context.which;
  for (const Hypothesis& h : hypotheses) out.report.push_back({h.name, h.held_out, false});
  if (hypotheses.empty()) return out;
  best_first(hypotheses);
  out.winner = hypotheses.front();
  for (StartReport& r : out.report) r.won = r.name == out.winner.name;
  return out;
}

}  // namespace polar
