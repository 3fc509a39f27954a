#include "compete.hpp"

#include <algorithm>
#include <cmath>

#include "../data/evidence.hpp"
#include "known_template.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar_start.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kRegrownStage = 27;
constexpr std::size_t kReferences = 24;  // views whose poses are tried as the common rotation

struct Hypothesis {
  SoftState state;
  Evidence evidence;
  bool crowded = false;
  StartReport report;
  bool of_known = false;  // begun under the known template, or grown again from such a one
};

class Contest {
 public:
  Contest(const Problems& problems, const RegistrationOptions& options)
      : options_(options),
        problem_(problems.plain),
        which_(evenly(problems.plain.all, static_cast<std::size_t>(options.engine.proposals.views))),
        prior_(prior_of(options)),
        plain_(problems.plain, which_, options.engine.anneal, prior_),
        thinned_(problems.thinned, which_, options.engine.anneal, prior_),
        seed_(problems.plain.seed) {}

  void add(Hypothesis h) {
    ++number_;
    h.evidence = of(h.crowded).judge(h.state, number_);
    h.report.held_out_log_likelihood = mean_evidence(h.evidence);
    if (!entered_.empty()) {
      const Comparison c = compare(entered_[best_].evidence, h.evidence);
      h.report.gain = c.gain, h.report.gain_std = c.standard_error;
      won_ = c.gain > 0;
      clearly_ = c.better_by(1) || compare(h.evidence, entered_[best_].evidence).better_by(1);
    }
    entered_.push_back(std::move(h));
    if (entered_.size() == 1 || won_)
      second_ = best_, best_ = entered_.size() - 1;
    else if (entered_.size() == 2 ||
             mean_evidence(entered_[second_].evidence) < mean_evidence(entered_.back().evidence) ||
             second_ == best_)
      second_ = entered_.size() - 1;
  }

  Hypothesis random(int k) {
    const AnnealOptions& o = options_.engine.anneal;
    Hypothesis h{
        SoftState(plain_.frame()), {}, k % 2 == 0 && k > 0, {}, false};  // the second of two is thinned
    h.report.name = "random " + std::to_string(k);
    h.state = of(h.crowded).random_start(static_cast<std::uint64_t>(k));
    of(h.crowded).anneal(
        {o.sweeps, o.first_width, o.last_width, o.first_beta, o.last_beta, o.narrowing, true},
        static_cast<std::uint64_t>(k), h.state);
    return h;
  }

  Hypothesis from(const std::string& name, const std::vector<SoftPose>& pose, const std::vector<int>& posed,
                  std::uint64_t key) {
    Hypothesis h{SoftState(plain_.frame()), {}, false, {}, false};
    h.report.name = name;
    h.state = plain_.from_poses(pose, posed, options_.engine.proposals.regrown_width);
    plain_.anneal(growth_stage(options_.engine), key, h.state);
    return h;
  }

  Hypothesis known() {
    Hypothesis h{
        known_state(options_.known, plain_.frame(), problem_, options_.engine.proposals.regrown_width,
                    options_.engine.anneal.first_outlier_fraction),
        {},
        false,
        {},
        true};
    h.report.name = "template";
    plain_.continue_under(growth_stage(options_.engine), 902, h.state);
    return h;
  }

  Hypothesis regrown(int k) {
    const Hypothesis& from = entered_[best_];
    Hypothesis h{from.state, {}, from.crowded, {}, from.of_known};
    h.report.name = "regrown " + std::to_string(k);
    SoftState seed = from.state;
    seed.sample.assign(seed.sample.size(), {});
    for (const int v : share_at_random(which_, options_.engine.proposals.regrown_share,
                                       KeyedRandom(seed_, static_cast<std::uint64_t>(k), kRegrownStage)))
      seed.sample[static_cast<std::size_t>(v)] = from.state.sample[static_cast<std::size_t>(v)];
    of(h.crowded).fuse(options_.engine.proposals.regrown_width, seed);
    h.state.density = seed.density;
    h.state.outlier_fraction = seed.outlier_fraction;
    of(h.crowded).continue_under(growth_stage(options_.engine), 100 + static_cast<std::uint64_t>(k), h.state);
    return h;
  }

  /// Whether no more starts are needed: the best two pose the views alike, or the last said nothing new.
  bool agreed() const {
    if (entered_.size() < 2) return false;
    return agreement() >= options_.engine.proposals.agreeing_share || !clearly_;
  }
  /// Whether independent starts pose the views alike: nothing else is worth trying.
  bool settled() const { return independent_ >= options_.engine.proposals.agreeing_share; }
  /// To be called as long as no start comes from another one.
  void note_agreement() { independent_ = agreement(); }
  double agreement() const {
    if (entered_.size() < 2) return 0;
    return share_alike(entered_[best_].state.best, entered_[second_].state.best, which_,
                       options_.engine.proposals.alike_deg * kRadiansPerDegree);
  }
  bool last_won() const { return won_; }

  Competition result() {
    Competition out{entered_[best_].state, entered_[best_].crowded, {}, independent_, true};
    entered_[best_].report.won = true;
    for (const Hypothesis& h : entered_) out.report.push_back(h.report);
    if (wants(options_, "template"))
      out.warnings.push_back(
          entered_[best_].of_known
              ? warning_of(likeness_to_known(problem_, which_, options_))
              : "registration.template: start '" + entered_[best_].report.name +
                    "' explains localisations kept apart better; the average does not come "
                    "from the template");
    return out;
  }
  const SoftAnnealer& of(bool crowded) const { return crowded ? thinned_ : plain_; }
  const std::vector<int>& which() const { return which_; }

 private:
  const RegistrationOptions& options_;
  const Problem& problem_;
  std::vector<int> which_;
  PosePrior prior_;
  SoftAnnealer plain_, thinned_;
  std::uint64_t seed_, number_ = 0;
  std::vector<Hypothesis> entered_;
  std::size_t best_ = 0, second_ = 0;
  bool won_ = true, clearly_ = true;
  double independent_ = 0;
};

}  // namespace

double share_alike(const std::vector<SoftPose>& a, const std::vector<SoftPose>& b,
                   const std::vector<int>& which, double within_rad) {
  if (which.empty()) return 0;
  const float least = 1 + 2 * static_cast<float>(std::cos(within_rad));  // of a trace
  std::size_t most = 0;
  for (std::size_t r = 0; r < std::min(kReferences, which.size()); ++r) {
    const auto i = static_cast<std::size_t>(which[r * which.size() / std::min(kReferences, which.size())]);
    const Eigen::Matrix3f common = a[i].rotation * b[i].rotation.transpose();
    std::size_t alike = 0;
    for (const int v : which) {
      const auto j = static_cast<std::size_t>(v);
      if (a[j].rotation.cwiseProduct(common * b[j].rotation).sum() >= least) ++alike;
    }
    most = std::max(most, alike);
  }
  return static_cast<double>(most) / static_cast<double>(which.size());
}

Competition compete(const Problems& problems, const Autoencoder* model, const RegistrationOptions& options,
                    Progress& progress) {
  const ProposalOptions& o = options.engine.proposals;
  Contest contest(problems, options);
  const int total = o.most_starts + o.most_proposals + (wants(options, "template") ? 1 : 0);
  int done = 0;
  const auto step = [&](Hypothesis h) {
    contest.add(std::move(h));
    progress.step("starts", ++done, total);
    return !progress.cancelled();
  };
  const Competition cancelled{SoftState(contest.of(false).frame()), false, {}, 0, false};
  // Poses from elsewhere; false: cancelled.
  const auto posed_starts = [&] {
    if (wants(options, "imaged") &&
        !step(contest.from("imaged", std::vector<SoftPose>(problems.plain.size()), contest.which(), 900)))
      return false;
    if (!wants(options, "polar") || model == nullptr) return true;
    const std::vector<int> few = evenly(contest.which(), static_cast<std::size_t>(o.polar_views));
    return step(contest.from("polar", polar_poses(problems.plain, few, *model, options), few, 901));
  };
  if (wants(options, "template") && !step(contest.known())) return cancelled;
  if (!wants(options, "random")) {
    if (!posed_starts()) return cancelled;
  } else {
    for (int k = 1; k <= o.most_starts && (k <= o.fewest_starts || !contest.agreed()); ++k)
      if (!step(contest.random(k))) return cancelled;
    // They are asked for where random starts do not agree.
    if (!contest.agreed() && !posed_starts()) return cancelled;
  }
  contest.note_agreement();
  for (int k = 1, rejected = 0; k <= o.most_proposals && rejected < o.rejected && !contest.settled(); ++k) {
    if (!step(contest.regrown(k))) return cancelled;
    rejected = contest.last_won() ? 0 : rejected + 1;
  }
  return contest.result();
}

}  // namespace polar
