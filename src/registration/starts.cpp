#include "starts.hpp"

#include <algorithm>
#include <map>

#include "agreement.hpp"
#include "assembly.hpp"
#include "finish.hpp"
#include "short_runs.hpp"
#include "states.hpp"
#include "two_copies.hpp"

namespace polar {

namespace {

constexpr int kMostFinalists = 5;
constexpr double kTie = 0.01;  // a difference in log likelihood that short runs do not tell from none
constexpr double kFinalistLocalisations =
    130000;  // views x localisations that the finalists may cost together
// What two random starts share is neither a wrong basin nor two copies, which differ from start to start. A
// symmetric structure never agrees so, because its views are turned at will.
constexpr double kAgreement = 0.95;
constexpr std::size_t kViewsThatAgree = 10;  // fewer may agree by chance

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

// Keeps what came of the winner where held-out localisations agree.
void compare(const std::string& name, RoundState state, StartsOutcome& out) {
  const StartReport report{name, out.winner.held_out, state.held_out, state.held_out > out.winner.held_out};
  if (report.won) {
    for (StartReport& other : out.report) other.won = false;
    out.winner = std::move(state);
  }
  out.report.push_back(report);
}

// Where the winner holds the structure twice, it is registered again from one copy. False: cancelled.
bool undouble(const Problems& problems, const SearchGrid& grid, const RoundOptions& rounds,
              Progress& progress, Checkpoint& checkpoint, StartsOutcome& out) {
  const Problem& problem = problems.of(out.winner.crowded);
  const std::vector<int> which = views_of_one_copy(problem, out.winner);
  if (which.empty()) return true;
  RoundState state = with_one_copy(problem, rounds, which, out.winner);
  if (!run_rounds(problem, grid, rounds, progress, checkpoint, state)) return false;
  compare("one copy", std::move(state), out);
  return true;
}

// A winner that expected strands is registered again from its poses without expecting them: its template was
// kept from weak centres and thinned localisations. False: cancelled.
bool calm(const Problems& problems, const ShortRuns& runs, const SearchGrid& grid, const RoundOptions& rounds,
          Progress& progress, Checkpoint& checkpoint, StartsOutcome& out) {
  if (!out.finished || !out.winner.crowded) return true;
  PartOfCheckpoint here(checkpoint, "finalist without strands");
  RoundState state;
  if (!restore(here, "started", state)) {
    state = runs.state_of(runs.from(out.winner.pose));
    keep(here, "started", state);
  }
  if (!run_rounds(problems.plain, grid, rounds, progress, here, state)) return false;
  compare("without strands", std::move(state), out);
  return true;
}

// The starts that are registered on all views, by their number.
class Finalists {
 public:
  Finalists(const Problems& problems, const ShortRuns& runs, const SearchGrid& grid,
            const RoundOptions& rounds, Progress& progress, Checkpoint& checkpoint)
      : problems_(problems),
        runs_(runs),
        grid_(grid),
        rounds_(rounds),
        progress_(progress),
        checkpoint_(checkpoint) {}

  /// Registers those that are not yet registered; false: cancelled.
  bool add(const std::vector<Hypothesis>& best_first, std::size_t most) {
    for (std::size_t k = 0; k < std::min(most, best_first.size()); ++k)
      if (state_.count(best_first[k].number) == 0 && !add(best_first[k])) return false;
    return true;
  }

  bool has(const Hypothesis& h) const { return state_.count(h.number) > 0; }
  RoundState& of(const Hypothesis& h) { return state_.at(h.number); }

 private:
  bool add(const Hypothesis& h) {
    PartOfCheckpoint here(checkpoint_, "finalist " + std::to_string(h.number));
    RoundState state;
    if (!restore(here, "registered", state)) {
      state = runs_.state_of(h);
      if (!run_rounds(problems_.of(h.crowded), grid_, rounds_, progress_, here, state)) return false;
      keep(here, "registered", state);
    }
    state_.emplace(h.number, std::move(state));
    return true;
  }

  const Problems& problems_;
  const ShortRuns& runs_;
  const SearchGrid& grid_;
  const RoundOptions& rounds_;
  Progress& progress_;
  Checkpoint& checkpoint_;
  std::map<int, RoundState> state_;
};

void rank(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.held_out > b.held_out; });
}

std::size_t finalists_for(const Problem& problem, const std::vector<Hypothesis>& best_first) {
  const auto affordable = static_cast<int>(kFinalistLocalisations / std::max(1.0, problem.localisations));
  const bool tie = best_first.size() > 1 && best_first[0].held_out - best_first[1].held_out < kTie;
  return static_cast<std::size_t>(std::clamp(affordable, tie ? 2 : 1, kMostFinalists));
}

// Two registrations cost less than the starts that they may save.
bool may_agree(const Problem& problem) {
  return problem.size() >= kViewsThatAgree && problem.localisations <= kFinalistLocalisations;
}

// The best of the registered ones and a report of all.
void judge(const std::vector<Hypothesis>& best_first, Finalists& finalists, StartsOutcome& out) {
  const Hypothesis* best = nullptr;
  for (const Hypothesis& h : best_first) {
    out.report.push_back({h.name, h.held_out, 0, false});
    if (!finalists.has(h)) continue;
    out.report.back().final_held_out_log_likelihood = finalists.of(h).held_out;
    if (best == nullptr || finalists.of(h).held_out > finalists.of(*best).held_out) best = &h;
  }
  out.finished = best != nullptr;
  if (!out.finished) return;
  for (StartReport& report : out.report) report.won = report.name == best->name;
  out.winner = std::move(finalists.of(*best));
}

}  // namespace

StartsOutcome compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                      const SearchGrid& grid, const RoundOptions& rounds, Progress& progress,
                      Checkpoint& checkpoint) {
  const ShortRuns runs(problems, model, options);
  Finalists finalists(problems, runs, grid, rounds, progress, checkpoint);
  std::vector<Hypothesis> hypotheses;
  StartsOutcome out;
  for (const int count : {runs.few_random(), runs.random()}) {
    runs.run_until(count, progress, checkpoint, hypotheses);
    if (progress.cancelled()) return {};
    rank(hypotheses);
    if (hypotheses.size() < 2 || !may_agree(problems.plain)) continue;
    if (!finalists.add(hypotheses, 2)) return {};
    const double alike = agreement(finalists.of(hypotheses[0]).pose, finalists.of(hypotheses[1]).pose);
    if (alike < kAgreement) continue;
    out.agreement = alike;
    judge(hypotheses, finalists, out);
    return calm(problems, runs, grid, rounds, progress, checkpoint, out) ? out : StartsOutcome{};
  }
  runs.run_until(runs.all(), progress, checkpoint, hypotheses);
  if (progress.cancelled()) return {};
  rank(hypotheses);
  if (!finalists.add(hypotheses, finalists_for(problems.plain, hypotheses))) return {};
  judge(hypotheses, finalists, out);
  if (!calm(problems, runs, grid, rounds, progress, checkpoint, out)) return {};
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
