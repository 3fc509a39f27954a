#include "starts.hpp"

#include <algorithm>
#include <cmath>

#include "assembly.hpp"
#include "finish.hpp"
#include "polar_start.hpp"
#include "states.hpp"
#include "two_copies.hpp"

namespace polar {

namespace {

constexpr int kFewestRandom = 3, kMostRandom = 12;
constexpr double kLookUpBudget =
    3.0e9;                       // over all random starts: seconds on two cores, whatever the size of the set
constexpr double kShifts = 7.0;  // tried for every rotation
constexpr int kLongStarts = 6;   // that the budget must allow
constexpr double kLongest = 2.0;  // times the usual
constexpr int kMostFinalists = 5;
constexpr double kFinalistLocalisations =
    130000;  // views x localisations that the finalists may cost together

double look_ups_of_a_sweep(const StartContext& context, const AnnealingOptions& options) {
  double localisations = 0;
  for (const int i : context.which)
    localisations += static_cast<double>(context.fitted[static_cast<std::size_t>(i)].size());
  return std::max(1.0, localisations * options.rotations * kShifts);
}

// What the budget buys: where localisations are few a start is cheap and often fails, so starts are long
// there, with a template of more centres that ends sharper, and many.
AnnealingOptions annealing(const StartContext& context) {
  AnnealingOptions options;
  if (context.problem.planar()) return options;  // turns in the plane are few
  const double longer = std::clamp(
      kLookUpBudget / kLongStarts / look_ups_of_a_sweep(context, options) / options.sweeps, 1.0, kLongest);
  options.sweeps = static_cast<int>(options.sweeps * longer);
  options.centres = static_cast<int>(options.centres * longer);
  options.last_width /= std::sqrt(longer);
  return options;
}

int random_starts(const StartContext& context) {
  const AnnealingOptions usual;
  return std::clamp(static_cast<int>(kLookUpBudget / (look_ups_of_a_sweep(context, usual) * usual.sweeps)),
                    kFewestRandom, kMostRandom);
}

std::vector<Hypothesis> short_runs(const StartContext& thinned, const StartContext& plain,
                                   const Autoencoder* model, const RegistrationOptions& wishes,
                                   Progress& progress, Checkpoint& checkpoint) {
  const AnnealingOptions options = annealing(plain);
  const int random = wants(wishes, "random") ? random_starts(plain) : 0;
  const bool polar = wants(wishes, "polar");
  const int total = random + (polar ? 1 : 0) + (wants(wishes, "imaged") ? 1 : 0);
  std::vector<Hypothesis> hypotheses;
  for (int k = 0; k < total && !progress.cancelled(); ++k) {
    const std::string name = "start " + std::to_string(k);
    Hypothesis known;
    if (restore(checkpoint, name, known)) {
      hypotheses.push_back(std::move(known));
      continue;
    }
    if (k < random) {
      const bool crowded = k % 2 == 0;
      const StartContext& context = crowded ? thinned : plain;
      hypotheses.push_back(random_start(context, options.centres, k, crowded));
      anneal(context, options, false, hypotheses.back());
    } else {
      hypotheses.push_back(polar && k == random ? polar_start(plain, *model, wishes, options.centres, k)
                                                : imaged_start(plain, options.centres, k));
      AnnealingOptions gentle = options;  // the poses are meant to be near: begin narrower and colder
      gentle.first_width = 0.2;
      gentle.first_beta = 1;
      gentle.sweeps = options.sweeps / 2;
      anneal(plain, gentle, true, hypotheses.back());
    }
    keep(checkpoint, name, hypotheses.back());
    progress.step("starts", k + 1, total);
  }
  return hypotheses;
}

double score_of_parts(const Problem& problem, const RoundState& state) {
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = state.width;
  return held_out_score_of_parts(problem, noise, state);
}

// Pairs of views have the last word: where they contradict the winner, or there is none, what they say is
// registered too. Both are then judged as parts. False: cancelled.
bool challenge(const Problems& problems, const SearchGrid& grid, const RoundOptions& rounds,
               Progress& progress, Checkpoint& checkpoint, StartsOutcome& out) {
  const Problem& problem = problems.thinned;
  RoundState state;
  if (!restore(checkpoint, "pairs", state)) {
    const Assembly assembly(problem);
    if (out.finished && !assembly.contradicts(out.winner.pose)) return true;
    state = assembly.assembled(rounds, progress);
    if (progress.cancelled()) return false;
    keep(checkpoint, "pairs", state);
  }
  if (!run_rounds(problem, grid, rounds, progress, checkpoint, state)) return false;
  StartReport report{"assembled", score_of_parts(problem, state), state.held_out, false};
  if (!out.finished ||
      report.held_out_log_likelihood > score_of_parts(problems.of(out.winner.crowded), out.winner)) {
    for (StartReport& other : out.report) other.won = false;
    report.won = true;
    out.winner = std::move(state);
    out.finished = true;
  }
  out.report.push_back(report);
  return true;
}

// Where the winner holds the structure twice, it is registered again from one copy. False: cancelled.
bool undouble(const Problems& problems, const SearchGrid& grid, const RoundOptions& rounds,
              Progress& progress, Checkpoint& checkpoint, StartsOutcome& out) {
  const Problem& problem = problems.of(out.winner.crowded);
  const std::vector<int> which = views_of_one_copy(problem, out.winner);
  if (which.empty()) return true;
  RoundState state = with_one_copy(problem, rounds, which, out.winner);
  if (!run_rounds(problem, grid, rounds, progress, checkpoint, state)) return false;
  const StartReport report{"one copy", out.winner.held_out, state.held_out,
                           state.held_out > out.winner.held_out};
  if (report.won) {
    for (StartReport& other : out.report) other.won = false;
    out.winner = std::move(state);
  }
  out.report.push_back(report);
  return true;
}

RoundState state_of(const StartContext& context, const Hypothesis& h) {
  RoundState state;
  state.mixture = h.mixture;
  state.crowded = h.crowded;
  state.pose.resize(context.problem.size());
  for (std::size_t k = 0; k < context.which.size(); ++k)
    state.pose[static_cast<std::size_t>(context.which[k])] = h.pose[k];
  return state;
}

}  // namespace

StartsOutcome compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                      const SearchGrid& grid, const RoundOptions& rounds, Progress& progress,
                      Checkpoint& checkpoint) {
  const StartContext thinned = start_context(problems.thinned), plain = start_context(problems.plain);
  std::vector<Hypothesis> hypotheses = short_runs(thinned, plain, model, options, progress, checkpoint);
  if (progress.cancelled()) return {};
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.held_out > b.held_out; });
  StartsOutcome out;
  for (const Hypothesis& h : hypotheses) out.report.push_back({h.name, h.held_out, 0, false});
  const std::size_t finalists =
      std::min(hypotheses.size(),
               static_cast<std::size_t>(std::clamp(
                   static_cast<int>(kFinalistLocalisations / std::max(1.0, problems.plain.localisations)), 1,
                   kMostFinalists)));
  std::size_t best = 0;
  for (std::size_t k = 0; k < finalists; ++k) {
    PartOfCheckpoint here(checkpoint, "finalist " + std::to_string(k));
    RoundState state;
    if (!restore(here, "registered", state)) {
      state = state_of(hypotheses[k].crowded ? thinned : plain, hypotheses[k]);
      if (!run_rounds(problems.of(hypotheses[k].crowded), grid, rounds, progress, here, state)) return {};
      keep(here, "registered", state);
    }
    out.report[k].final_held_out_log_likelihood = state.held_out;
    if (k > 0 &&
        out.report[k].final_held_out_log_likelihood <= out.report[best].final_held_out_log_likelihood)
      continue;
    best = k;
    out.winner = std::move(state);
    out.finished = true;
  }
  if (out.finished) out.report[best].won = true;
  if (wants(options, "assembled")) {
    PartOfCheckpoint here(checkpoint, "finalist assembled");
    if (!challenge(problems, grid, rounds, progress, here, out)) return {};
  }
  if (out.finished) {
    PartOfCheckpoint here(checkpoint, "finalist of one copy");
    if (!undouble(problems, grid, rounds, progress, here, out)) return {};
  }
  return out;
}

}  // namespace polar
