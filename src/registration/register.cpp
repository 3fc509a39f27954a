// One loop: coarse hypotheses compete, the symmetry of the best is tried, the exact template is refined, its
// symmetry tested against doing without, and what came of it is reported.
#include "polar/registration/register.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "account/report.hpp"
#include "account/verdict.hpp"
#include "data/template_tools.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/symmetry_group.hpp"
#include "proposals/compete.hpp"
#include "proposals/latent_method.hpp"
#include "proposals/polar_start.hpp"
#include "smlm/error.hpp"
#include "states.hpp"
#include "symmetry/relaxation.hpp"
#include "symmetry/symmetry_trials.hpp"
#include "symmetry/symmetry_units.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kRegrownStage = 29;
constexpr double kLargestFactor = 1.5;  // of a, either way, before a warning

class Stopwatch {
 public:
  Registration::Timing lap(const char* stage) {
    const auto now = std::chrono::steady_clock::now();
    const std::clock_t busy = std::clock();
    Registration::Timing out{stage, std::chrono::duration<double>(now - last_).count(),
                             static_cast<double>(busy - busy_) / CLOCKS_PER_SEC};
    last_ = now, busy_ = busy;
    return out;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::clock_t busy_ = std::clock();
};

void warn_about_calibration(const Calibration& c, std::vector<std::string>& warnings) {
  const auto warn = [&](const char* axis, double a) {
    if (a > kLargestFactor || a < 1 / kLargestFactor)
      warnings.push_back(std::string("the ") + axis +
                         " uncertainties of the table do not describe its noise: the data want them times " +
                         std::to_string(a).substr(0, 4) + "; the calibrated ones were used");
  };
  warn("lateral", c.lateral_factor);
  if (c.axial_factor != c.lateral_factor) warn("axial", c.axial_factor);
}

bool names_a_group(const std::string& symmetry) {
  return symmetry != "auto" && symmetry != "none" && symmetry != "detect";
}

// Only the table tells whether the data are planar.
void check_planar(const Views& views, const RegistrationOptions& options) {
  if (!views.planar) return;
  if (names_a_group(options.symmetry) && options.symmetry[0] != 'C')
    throw smlm::Error(smlm::Fault::usage, "registration.symmetry",
                      "'" + options.symmetry + "' is not a group of planar data",
                      "use auto, none, detect or C<n>");
}

std::vector<Pose> poses_of(const std::vector<SoftPose>& soft) {
  std::vector<Pose> out;
  for (const SoftPose& p : soft) out.push_back({p.rotation.cast<double>(), p.translation.cast<double>()});
  return out;
}

class Run {
 public:
  Run(const Views& views, const RegistrationOptions& options, Progress& progress, Checkpoint& checkpoint)
      : options_(options),
        views_(views),
        problems_(make_problems(views, options.engine.evidence, options.seed)),
        progress_(progress),
        checkpoint_(checkpoint) {
    out_.view.resize(views.view.size());
    timed("views");
  }

  Registration from_nothing() {
    CoarseState coarse;
    if (!restore(checkpoint_, "coarse", coarse)) {
      if (!find(coarse)) return cancelled();
      keep(checkpoint_, "coarse", coarse);
    } else {
      split_bursts(coarse.noise);
    }
    return finish(std::move(coarse));
  }

  Registration from_poses(const std::vector<Pose>& pose) {
    CoarseState coarse;
    coarse.pose = pose;
    if (names_a_group(options_.symmetry)) coarse.group = options_.symmetry;
    find_noise(coarse);
    return finish(std::move(coarse));
  }

 private:
  void timed(const char* stage) { out_.timings.push_back(watch_.lap(stage)); }
  Registration cancelled() {
    out_.stopped_because = "cancelled";
    out_.verdict_reason = "cancelled";
    return std::move(out_);
  }

  // Coarse poses of all views and the group they are under.
  bool find(CoarseState& coarse) {
    const LatentModel model = latent_model(options_);
    Competition found = compete(*problems_, model.autoencoder.get(), options_, progress_);
    timed("starts");
    if (!found.finished) return false;
    coarse.crowded = found.crowded;
    coarse.starts = std::move(found.report);
    coarse.agreement = found.agreement;
    coarse.warnings = std::move(found.warnings);
    coarse.weights_sha256 = model.weights_sha256;
    const SoftState& state = found.winner;
    coarse.pose = all_posed(coarse, state);
    timed("all views");
    find_noise(coarse);
    if (progress_.cancelled()) return false;
    const std::string asked = names_a_group(options_.symmetry) ? options_.symmetry : "";
    if (options_.symmetry != "none") {
      SymmetryChoice choice =
          choose_symmetry(problems_->of(coarse.crowded), options_, state, asked,
                          coarse.agreement >= options_.engine.proposals.agreeing_share, progress_);
      if (progress_.cancelled()) return false;
      coarse.symmetry = std::move(choice.report);
      coarse.continuous = choice.continuous;
      if (options_.symmetry != "detect") {
        coarse.group = choice.group;
        coarse.pose = all_posed(coarse, std::move(choice.state));
        choose_among(std::move(choice.rival), coarse);
      }
      timed("symmetry");
    }
    return !progress_.cancelled();
  }

  Registration finish(CoarseState coarse) {
    const RefineOptions& refine = options_.engine.refine;
    const bool exhaustive = options_.search == "exhaustive";
    const int rotations = views_.planar ? (exhaustive ? kExhaustivePlanarRotations : refine.planar_rotations)
                                        : (exhaustive ? kExhaustiveRotations : refine.rotations);
    const RotationGroup group = rotations_of(coarse.group);
    const SearchGrid grid = search_grid(rotations, views_.planar, group, prior_of(options_));
    const Problem& problem = problems_->of(coarse.crowded);
    const Refiner refiner(problem, grid, options_.engine);
    Fit fit;
    if (!restore(checkpoint_, "fine", fit)) {
      fit = refiner.rounds(refiner.begin(std::move(coarse.pose), coarse.noise, group), progress_);
      timed("rounds");
      if (coarse.agreement < options_.engine.proposals.agreeing_share)
        fit = regrown(problem, refiner, std::move(fit));
      timed("regrown");
      if (progress_.cancelled()) return cancelled();
      fit = refiner.calibrated(std::move(fit));
      timed("calibration");
      fit = refiner.discrete(std::move(fit));
      timed("centres");
      fit = refiner.last_round(std::move(fit));
      timed("last search");
      if (progress_.cancelled()) return cancelled();
      keep(checkpoint_, "fine", fit);
    }
    out_.symmetry = coarse.symmetry;
    if (!group.empty()) fit = tested(problem, coarse.group, std::move(fit));
    timed("symmetry tested");
    const Refiner::AgainstCloud against = against_cloud(grid, problem, fit);
    timed("verdict");
    if (progress_.cancelled()) return cancelled();
    report_views(problem, options_.engine, fit, out_);
    timed("polish");
    judge_registration(against.cloud, against.structure, options_.engine.verdict, out_);
    conclude(problem, coarse, fit);
    return std::move(out_);
  }

  // Poses of all views under the template of those that competed.
  std::vector<Pose> all_posed(const CoarseState& coarse, SoftState state) const {
    const AnnealOptions& a = options_.engine.anneal;
    const Problem& problem = problems_->of(coarse.crowded);
    SoftAnnealer(problem, problem.all, a, prior_of(options_))
        .continue_under({a.last_sweeps, a.last_width, a.last_width, a.last_beta, a.last_beta, 1, false}, 4000,
                        state);
    return poses_of(state.best);
  }

  // Which localisations share a label, and so what may judge, is known only when the noise is.
  void find_noise(CoarseState& coarse) {
    const SearchGrid none;
    const Refiner refiner(problems_->of(coarse.crowded), none, options_.engine);
    coarse.noise =
        refiner.with_noise(refiner.begin(coarse.pose, NoiseModel{}, rotations_of(coarse.group))).noise;
    split_bursts(coarse.noise);
    timed("noise");
  }

  void split_bursts(const NoiseModel& noise) {
    if (noise.lateral_factor != 1 || noise.axial_factor != 1)
      problems_.emplace(make_problems(views_, options_.engine.evidence, options_.seed, noise));
  }

  // Coarse evidence hardly tells orders of an axis apart; exact templates do.
  void choose_among(std::vector<SymmetryChoice::Rival> rivals, CoarseState& coarse) const {
    if (rivals.empty()) return;
    const SearchGrid none;
    Problem problem = problems_->of(coarse.crowded);
    const Refiner refiner(problem, none, options_.engine);
    const auto judged = [&](const std::string& group, const std::vector<Pose>& pose) {
      hold_out(options_.engine.evidence, 0, problem);
      const Fit fit =
          refiner.narrowed(refiner.judged(refiner.begin(pose, coarse.noise, rotations_of(group))));
      return over_draws(options_.engine.evidence, options_.engine.symmetry.draws, problem,
                        [&] { return refiner.judge(fit); });
    };
    Evidence best = judged(coarse.group, coarse.pose);
    for (SymmetryChoice::Rival& r : rivals) {
      std::vector<Pose> pose = all_posed(coarse, std::move(r.state));
      Evidence e = judged(r.group, pose);
      if (!compare(best, e).better_by(0)) continue;
      best = std::move(e);
      coarse.group = r.group, coarse.pose = std::move(pose);
      coarse.symmetry->group = r.group;
      for (const SymmetryTrial& t : coarse.symmetry->tried)
        if (t.group == r.group) coarse.symmetry->gain = t.gain, coarse.symmetry->gain_std = t.gain_std;
    }
  }

  // The template grown again from the poses of some views, as long as evidence gains by it: a hot spot
  // between two labels is no place to climb from.
  Fit regrown(const Problem& problem, const Refiner& refiner, Fit fit) {
    const ProposalOptions& p = options_.engine.proposals;
    const SoftAnnealer annealer(problem, problem.all, options_.engine.anneal, prior_of(options_));
    for (int k = 1, rejected = 0;
         k <= p.most_proposals && rejected < p.fine_rejected && !progress_.cancelled(); ++k) {
      const std::vector<int> some =
          share_at_random(problem.all, p.regrown_share,
                          KeyedRandom(problem.seed, static_cast<std::uint64_t>(k), kRegrownStage));
      SoftState state = annealer.from_poses(soft_poses_of(fit.pose), some, p.regrown_width);
      state.group = fit.group;
      annealer.anneal(growth_stage(options_.engine), 5000 + static_cast<std::uint64_t>(k), state);
      Fit next = refiner.rounds(refiner.begin(poses_of(state.best), fit.noise, fit.group), progress_);
      const Comparison c = compare(fit.evidence, next.evidence);
      const bool better = c.better_by(0);  // neither is the simpler one
      rejected = better ? 0 : rejected + 1;
      if (better) fit = std::move(next);
    }
    return fit;
  }

  // Several draws of what judges: a view says little by a few of its bursts.
  Refiner::AgainstCloud against_cloud(const SearchGrid& grid, const Problem& problem, const Fit& fit) const {
    const VerdictOptions& o = options_.engine.verdict;
    Problem other = problem;
    EvidenceOptions evidence = options_.engine.evidence;
    evidence.held_out_share = o.held_out_share;
    const Refiner refiner(other, grid, options_.engine);
    std::vector<Evidence> structure, cloud;
    Refiner::AgainstCloud mean;
    for (int draw = 1; draw <= o.draws && !progress_.cancelled(); ++draw) {
      hold_out(evidence, static_cast<std::uint64_t>(draw), other);
      Refiner::AgainstCloud one = refiner.judge_against_cloud(fit);
      structure.push_back(std::move(one.structure)), cloud.push_back(std::move(one.cloud));
      mean = {mean_over(structure), mean_over(cloud)};
      const Comparison c = over_cloud(mean.cloud, mean.structure, o);
      if (std::abs(c.gain) > o.enough_standard_errors * c.standard_error) break;
    }
    return mean;
  }

  // With the group against without; evidence decides which is the result.
  Fit tested(const Problem& problem, const std::string& name, Fit symmetric) {
    auto [plain, c] = relaxed(problem, options_.engine, symmetric);
    const bool without =
        c.better_by(options_.engine.evidence.standard_errors) && !names_a_group(options_.symmetry);
    if (out_.symmetry) out_.symmetry->in_use = !without;
    const double sign = without ? -1 : 1;
    out_.other = OtherTemplate{without ? name : "C1", fused_template(without ? symmetric : plain),
                               sign * c.gain, c.standard_error};
    return without ? std::move(plain) : std::move(symmetric);
  }

  void conclude(const Problem& problem, const CoarseState& coarse, const Fit& fit) {
    out_.starts = coarse.starts;
    out_.agreement = coarse.agreement;
    out_.weights_sha256 = coarse.weights_sha256;
    out_.warnings.insert(out_.warnings.end(), coarse.warnings.begin(), coarse.warnings.end());
    out_.history = fit.history;
    out_.rounds = fit.rounds;
    out_.converged = fit.escaped <= options_.engine.refine.settled * static_cast<double>(problem.size());
    out_.stopped_because = std::to_string(fit.escaped) + " of " + std::to_string(problem.size()) +
                           " particles moved by more than 15 degrees in the last search";
    warn_about_calibration(out_.calibration, out_.warnings);
    if (!out_.symmetry) return;
    warn_about_symmetry(*out_.symmetry);
    if (rotations_of(out_.symmetry->group).size() > 1 && out_.symmetry->in_use) count_units(problem, out_);
    if (coarse.continuous) out_.symmetry->group = out_.symmetry->group.substr(0, 1) + "inf";
  }

  // Where a group was asked for: which one explains localisations kept apart better.
  void warn_about_symmetry(const Symmetry& s) {
    if (!s.asked) return;
    const SymmetryTrial* best = nullptr;
    for (const SymmetryTrial& t : s.tried)
      if (best == nullptr || t.gain > best->gain) best = &t;
    const auto text = [](double v) { return std::to_string(v).substr(0, 6); };
    if (best != nullptr && best->gain > std::max(0.0, s.gain) && best->group != s.group &&
        best->gain - s.gain > std::hypot(best->gain_std, s.gain_std))
      out_.warnings.push_back("registration.symmetry: " + s.group +
                              " explains localisations kept apart worse than " + best->group + " does, by " +
                              text(best->gain - s.gain) + " nat each");
    if (s.gain < -s.gain_std)
      out_.warnings.push_back("registration.symmetry: " + s.group +
                              " explains localisations kept apart worse than no symmetry does, by " +
                              text(-s.gain) + " +- " + text(s.gain_std) + " nat each");
  }

  const RegistrationOptions& options_;
  const Views& views_;
  std::optional<Problems> problems_;
  Progress& progress_;
  Checkpoint& checkpoint_;
  Stopwatch watch_;
  Registration out_;
};

}  // namespace

Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress) {
  Checkpoint nothing;
  return register_views(views, options, progress, nothing);
}

Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress,
                            Checkpoint& checkpoint) {
  check_planar(views, options);
  if (options.method == "latent") {
    const LatentModel model = latent_model(options);
    Stopwatch watch;
    const Problems problems = make_problems(views, options.engine.evidence, options.seed);
    Registration out = latent_method(problems.plain, *model.autoencoder, options, progress);
    out.weights_sha256 = model.weights_sha256;
    out.timings.push_back(watch.lap("latent"));
    return out;
  }
  return Run(views, options, progress, checkpoint).from_nothing();
}

Registration register_from(const Views& views, const std::vector<Pose>& template_from_view,
                           const RegistrationOptions& options, Progress& progress) {
  check_planar(views, options);
  Checkpoint nothing;
  return Run(views, options, progress, nothing).from_poses(template_from_view);
}

}  // namespace polar
