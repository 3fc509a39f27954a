#include "short_runs.hpp"

#include <algorithm>
#include <cmath>

#include "polar_start.hpp"
#include "states.hpp"

namespace polar {

namespace {

constexpr int kFewestRandom = 3, kMostRandom = 12;
constexpr double kLookUpBudget =
    3.0e9;                       // over all random starts: seconds on two cores, whatever the size of the set
constexpr double kShifts = 7.0;  // tried for every rotation
constexpr int kLongStarts = 6;   // that the budget must allow
constexpr double kLongest = 2.0;  // times the usual
constexpr int kOneViews = 6;

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

}  // namespace

ShortRuns::ShortRuns(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options)
    : thinned_(start_context(problems.thinned)),
      plain_(start_context(problems.plain)),
      model_(model),
      options_(options),
      random_(wants(options, "random") ? random_starts(plain_) : 0),
      posed_(random_ + (wants(options, "polar") ? 1 : 0) + (wants(options, "imaged") ? 1 : 0)),
      all_(posed_ + (random_ > 0 && problems.plain.planar() ? kOneViews : 0)) {
  if (all_ > posed_) fullest_.emplace(fullest_context(problems.plain));
}

Hypothesis ShortRuns::run(int number) const {
  const AnnealingOptions usual = annealing(plain_);
  if (number < random_) {
    const bool crowded = number % 2 == 0;
    const StartContext& context = crowded ? thinned_ : plain_;
    Hypothesis h = random_start(context, usual.centres, number, crowded);
    anneal(context, usual, false, h);
    return h;
  }
  if (number >= posed_) return one_view(number);
  Hypothesis h = wants(options_, "polar") && number == random_
                     ? polar_start(plain_, *model_, options_, usual.centres, number)
                     : imaged_start(plain_, usual.centres, number);
  settle(h);
  return h;
}

// In the plane a template from nothing stays one of nothing where half of the labels are missing: what the
// views share is finer than the blur that begins. The fullest views find each other.
Hypothesis ShortRuns::one_view(int number) const {
  AnnealingOptions options = annealing(*fullest_);
  options.first_width = 0.15, options.last_width = 0.06;
  options.first_beta = 0.5;
  options.reach = RoundOptions().stray_reach;
  Hypothesis h = one_view_start(*fullest_, options.centres, number, number - posed_);
  anneal(*fullest_, options, false, h);
  return h;
}

// Where the poses are meant to be near: begins narrower and colder.
void ShortRuns::settle(Hypothesis& h) const {
  AnnealingOptions gentle = annealing(plain_);
  gentle.first_width = 0.2;
  gentle.first_beta = 1;
  gentle.sweeps /= 2;
  anneal(plain_, gentle, true, h);
}

Hypothesis ShortRuns::from(const std::vector<Pose>& pose) const {
  Hypothesis h;
  h.number = all_;
  for (const int i : plain_.which) h.pose.push_back(pose[static_cast<std::size_t>(i)]);
  h = with_template(plain_, annealing(plain_).centres, std::move(h));
  settle(h);
  return h;
}

int ShortRuns::few_random() const { return std::min(random_, kFewestRandom); }

void ShortRuns::run_until(int count, Progress& progress, Checkpoint& checkpoint,
                          std::vector<Hypothesis>& out) const {
  for (auto k = static_cast<int>(out.size()); k < count && !progress.cancelled(); ++k) {
    const std::string name = "start " + std::to_string(k);
    Hypothesis h;
    if (!restore(checkpoint, name, h)) {
      h = run(k);
      keep(checkpoint, name, h);
      progress.step("starts", k + 1, all_);
    }
    out.push_back(std::move(h));
  }
}

RoundState ShortRuns::state_of(const Hypothesis& h) const {
  const StartContext& context = h.one_view ? *fullest_ : h.crowded ? thinned_ : plain_;
  RoundState state;
  state.mixture = h.mixture;
  state.crowded = h.crowded;
  state.one_view = h.one_view;
  state.pose.resize(context.problem.size());
  for (std::size_t k = 0; k < context.which.size(); ++k)
    state.pose[static_cast<std::size_t>(context.which[k])] = h.pose[k];
  return state;
}

}  // namespace polar
