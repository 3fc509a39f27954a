#include "starts.hpp"

#include <algorithm>
#include <map>

#include "agreement.hpp"
#include "assembly.hpp"
#include "finish.hpp"
#include "short_runs.hpp"
#include "sides.hpp"
#include "states.hpp"
#include "template_tools.hpp"
#include "two_copies.hpp"

namespace polar {

namespace {

constexpr int kMostFinalists = 5, kOneViewFinalists = 2;
constexpr double kTie = 0.01;  // a difference in log likelihood that short runs do not tell from none
constexpr double kFinalistLocalisations =
    130000;  // views x localisations that the finalists may cost together
// What two random starts share is neither a wrong basin nor two copies, which differ from start to start. A
// symmetric structure never agrees so, because its views are turned at will.
constexpr double kAgreement = 0.95;
constexpr double kLooksCut =
    0.05;  // nats a localisation that the likeliest cuts explain: 0.08 to 0.14 of cut views
constexpr double kMostStrands = 0.2;         // share of outliers among cut views; among strands 0.16 to 0.5
constexpr std::size_t kViewsThatAgree = 10;  // fewer may agree by chance

// Of held-out localisations, views taken as parts of the structure: cut by planes or anyhow.
double score_of_parts(const Problem& problem, const RoundState& state, bool cut) {
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = state.width;
  return cut ? held_out_score(problem, state.mixture, state.pose, noise, true)
             : held_out_score_of_parts(problem, noise, state);
}

// Each step is false where it was cancelled; the checkpoint then holds what was done.
class Competition {
 public:
  Competition(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
              const SearchGrid& grid, const RoundOptions& rounds, Progress& progress, Checkpoint& checkpoint)
      : problems_(problems),
        options_(options),
        grid_(grid),
        rounds_(rounds),
        progress_(progress),
        checkpoint_(checkpoint),
        runs_(problems, model, options) {}

  bool run() {
    if (!run_until_two_agree()) return false;
    if (!agreed()) {
      if (!run_until(runs_.all()) || !register_best(finalists(), false) ||
          !register_best(kOneViewFinalists, true))
        return false;
      judge();
    }
    return without_strands() && ask_pairs() && undouble() && side_turned() && turned_back();
  }
  StartsOutcome outcome() { return std::move(out_); }

 private:
  bool agreed() const { return out_.agreement > 0; }

  // Short runs of the first so many starts, ranked: those of one view, which end sharper, among themselves.
  bool run_until(int count) {
    runs_.run_until(count, progress_, checkpoint_, best_first_);
    std::stable_sort(best_first_.begin(), best_first_.end(), [](const Hypothesis& a, const Hypothesis& b) {
      return a.one_view != b.one_view ? b.one_view : a.held_out > b.held_out;
    });
    return !progress_.cancelled();
  }

  bool registered(const std::string& name, bool crowded, RoundState& state) {
    PartOfCheckpoint here(checkpoint_, "finalist " + name);
    if (restore(here, "registered", state)) return true;
    if (!run_rounds(problems_.of(crowded), grid_, rounds_, progress_, here, state)) return false;
    keep(here, "registered", state);
    return true;
  }

  bool register_best(std::size_t most, bool of_one_view) {
    for (const Hypothesis& h : best_first_) {
      if (h.one_view != of_one_view) continue;
      if (most-- == 0) break;
      if (finalist_.count(h.number) > 0) continue;
      RoundState state = runs_.state_of(h);
      if (!registered(std::to_string(h.number), h.crowded, state)) return false;
      finalist_.emplace(h.number, std::move(state));
    }
    return true;
  }

  std::size_t finalists() const {
    const auto affordable =
        static_cast<int>(kFinalistLocalisations / std::max(1.0, problems_.plain.localisations));
    const bool tie = best_first_.size() > 1 && best_first_[0].held_out - best_first_[1].held_out < kTie;
    return static_cast<std::size_t>(std::clamp(affordable, tie ? 2 : 1, kMostFinalists));
  }

  bool run_until_two_agree() {
    // Two registrations cost less than the starts that they may save.
    const bool worth_it =
        problems_.plain.size() >= kViewsThatAgree && problems_.plain.localisations <= kFinalistLocalisations;
    for (const int count : {runs_.few_random(), runs_.random()}) {
      if (count == static_cast<int>(best_first_.size())) break;  // all of them were few
      if (!run_until(count)) return false;
      if (!worth_it || best_first_.size() < 2) continue;
      if (!register_best(2, false)) return false;
      const double alike =
          agreement(finalist_.at(best_first_[0].number).pose, finalist_.at(best_first_[1].number).pose);
      if (alike < kAgreement) continue;
      out_.agreement = alike;
      judge();
      return true;
    }
    return true;
  }

  // The best of the registered ones and a report of all.
  void judge() {
    for (const Hypothesis& h : best_first_) {
      const auto found = finalist_.find(h.number);
      StartReport report{h.name, h.held_out, 0, false};
      if (found == finalist_.end()) {
        out_.report.push_back(report);
        continue;
      }
      report.final_held_out_log_likelihood = found->second.held_out;
      report.won = !out_.finished || found->second.held_out > out_.winner.held_out;
      enter(report, std::move(found->second));
    }
  }

  void enter(const StartReport& report, RoundState state) {
    if (report.won) {
      for (StartReport& other : out_.report) other.won = false;
      out_.winner = std::move(state);
      out_.finished = true;
    }
    out_.report.push_back(report);
  }

  // Registers what came of the winner, and keeps it where held-out localisations agree.
  bool once_more(const std::string& name, bool crowded, RoundState state) {
    if (!registered(name, crowded, state)) return false;
    const StartReport report{name, out_.winner.held_out, state.held_out,
                             state.held_out > out_.winner.held_out};
    enter(report, std::move(state));
    return true;
  }

  // A winner that expected strands is registered again from its poses without expecting them: its template
  // was kept from weak centres and thinned localisations.
  bool without_strands() {
    if (!out_.finished || !out_.winner.crowded) return true;
    RoundState state;
    PartOfCheckpoint here(checkpoint_, "finalist without strands");
    if (!restore(here, "started", state)) {
      state = runs_.state_of(runs_.from(out_.winner.pose));
      keep(here, "started", state);
    }
    return once_more("without strands", false, std::move(state));
  }

  // Whether the template reaches farther than views do, by planes that cut them. A strand reaches anywhere:
  // where there are many, nothing is known of planes.
  bool looks_cut() const {
    if (!out_.finished || problems_.plain.planar()) return false;
    const RoundState& winner = out_.winner;
    return !winner.crowded && winner.mixture.outlier_fraction < kMostStrands &&
           mean_gain_of_cuts(problems_.plain, winner.mixture, winner.pose) > kLooksCut;
  }

  // Pairs of views have the last word: where they contradict the winner, or there is none, what they say is
  // registered too. Both are then judged as parts. Where two starts agree only cut views are asked: those
  // that are laid over each other are the same in both, because it is them that look so.
  bool ask_pairs() {
    if (!wants(options_, "assembled")) return true;
    const bool cut = looks_cut();
    if (agreed() && !cut) return true;
    const Problem& problem = problems_.of(!cut);
    PartOfCheckpoint here(checkpoint_, "finalist assembled");
    RoundState state;
    if (!restore(here, "pairs", state)) {
      const Assembly assembly(problem);
      const bool doubtful = !out_.finished || (cut && !agreed());
      if (!doubtful && !assembly.contradicts(out_.winner.pose)) return true;
      state = assembly.assembled(rounds_, cut, progress_);
      if (progress_.cancelled()) return false;
      keep(here, "pairs", state);
    }
    if (!registered("assembled", !cut, state)) return false;
    StartReport report{"assembled", score_of_parts(problem, state, cut), state.held_out, false};
    report.won = !out_.finished || report.held_out_log_likelihood >
                                       score_of_parts(problems_.of(out_.winner.crowded), out_.winner, cut);
    enter(report, std::move(state));
    return true;
  }

  // Where the winner holds the structure twice, it is registered again from one copy; starts do not agree on
  // two copies but of cut views.
  bool undouble() {
    if (!out_.finished || (agreed() && !out_.winner.cut)) return true;
    return once_more_from(views_of_one_copy(problems_.of(out_.winner.crowded), out_.winner), "one copy",
                          out_.winner);
  }

  // Where crops of one side are posed against those of the other.
  bool side_turned() {
    if (!out_.finished) return true;
    RoundState state = out_.winner;
    const std::vector<int> which = turn_side(problems_.of(state.crowded), state);
    return once_more_from(which, "side turned", std::move(state));
  }

  // Where the winner poses some views half a turn off: two starts may agree on that, because it is the same
  // views that look so.
  bool turned_back() {
    if (!out_.finished) return true;
    RoundState state = out_.winner;
    const std::vector<int> which = turn_back(problems_.of(state.crowded), state);
    return once_more_from(which, "turned back", std::move(state));
  }

  // From a template of the views `which` alone; nothing is done where there are none.
  bool once_more_from(const std::vector<int>& which, const std::string& name, RoundState state) {
    if (which.empty()) return true;
    const bool crowded = state.crowded;
    fuse_anew(problems_.of(crowded), rounds_, which, state);
    state.far = state.cut;
    return once_more(name, crowded, std::move(state));
  }

  const Problems& problems_;
  const RegistrationOptions& options_;
  const SearchGrid& grid_;
  const RoundOptions& rounds_;
  Progress& progress_;
  Checkpoint& checkpoint_;
  const ShortRuns runs_;
  std::vector<Hypothesis> best_first_;
  std::map<int, RoundState> finalist_;  // registered on all views, by the number of the hypothesis
  StartsOutcome out_;
};

}  // namespace

StartsOutcome compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                      const SearchGrid& grid, const RoundOptions& rounds, Progress& progress,
                      Checkpoint& checkpoint) {
  Competition competition(problems, model, options, grid, rounds, progress, checkpoint);
  if (!competition.run()) return {};
  return competition.outcome();
}

}  // namespace polar
