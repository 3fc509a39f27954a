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

constexpr std::uint64_t kDrawSeed = 7919;  // between the draws of what judges the verdict
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
    }
    return finish(std::move(coarse));
  }

  Registration from_poses(const std::vector<Pose>& pose) {
    CoarseState coarse;
    coarse.pose = pose;
    if (names_a_group(options_.symmetry)) coarse.group = options_.symmetry;
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
    const Problem& problem = problems_->of(coarse.crowded);
    SoftState state = std::move(found.winner);
    if (options_.symmetry != "none") {
      const std::string asked = names_a_group(options_.symmetry) ? options_.symmetry : "";
      SymmetryChoice choice = choose_symmetry(problem, options_, state, asked, progress_);
      if (progress_.cancelled()) return false;
      coarse.symmetry = std::move(choice.report);
      coarse.continuous = choice.continuous;
      if (options_.symmetry != "detect") {
        coarse.group = choice.group;
        state = std::move(choice.state);
      }
      timed("symmetry");
    }
    const AnnealOptions& a = options_.engine.anneal;
    const SoftAnnealer all(problem, problem.all, a, prior_of(options_));
    all.continue_under({a.last_sweeps, a.last_width, a.last_width, a.last_beta, a.last_beta, 1, false}, 4000,
                       state);
    coarse.pose = poses_of(state.best);
    timed("all views");
    return !progress_.cancelled();
  }

  Registration finish(CoarseState coarse) {
    const RefineOptions& refine = options_.engine.refine;
    const bool exhaustive = options_.search == "exhaustive";
    const int rotations = views_.planar ? (exhaustive ? kExhaustivePlanarRotations : refine.planar_rotations)
                                        : (exhaustive ? kExhaustiveRotations : refine.rotations);
    const RotationGroup group = rotations_of(coarse.group);
    const SearchGrid grid = search_grid(rotations, views_.planar, group);
    FineState fine;
    const bool known = restore(checkpoint_, "fine", fine);
    if (!known) {
      const Refiner first(problems_->of(coarse.crowded), grid, options_.engine);
      fine.fit = first.with_noise(first.begin(std::move(coarse.pose), NoiseModel{}, group));
      timed("noise");
      if (progress_.cancelled()) return cancelled();
    }
    if (!known) fine.splitting = fine.fit.noise;
    if (fine.splitting.lateral_factor != 1 || fine.splitting.axial_factor != 1)
      problems_.emplace(make_problems(views_, options_.engine.evidence, options_.seed, fine.splitting));
    const Problem& problem = problems_->of(coarse.crowded);
    const Refiner refiner(problem, grid, options_.engine);
    if (!known) {
      fine.fit = refiner.rounds(std::move(fine.fit), progress_);
      timed("rounds");
      fine.fit = regrown(problem, refiner, std::move(fine.fit));
      timed("regrown");
      if (progress_.cancelled()) return cancelled();
      fine.fit = refiner.calibrated(std::move(fine.fit));
      timed("calibration");
      fine.fit = refiner.discrete(std::move(fine.fit));
      timed("centres");
      refiner.search(fine.fit);
      refiner.sweep(fine.fit, refine.sweeps);
      fine.fit.evidence = refiner.judge(fine.fit);
      timed("last search");
      if (progress_.cancelled()) return cancelled();
      keep(checkpoint_, "fine", fine);
    }
    Fit fit = std::move(fine.fit);
    out_.symmetry = coarse.symmetry;
    if (!group.empty()) fit = tested(problem, refiner, coarse.group, std::move(fit));
    timed("symmetry tested");
    const Refiner::AgainstCloud against = against_cloud(grid, coarse.crowded, fit);
    timed("verdict");
    report_views(problem, options_.engine, fit, out_);
    timed("polish");
    judge_registration(against.cloud, against.structure, options_.engine.verdict, out_);
    conclude(problem, coarse, fit);
    return std::move(out_);
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
      const bool better = c.better_by(options_.engine.evidence.standard_errors);
      rejected = better ? 0 : rejected + 1;
      if (better) fit = std::move(next);
    }
    return fit;
  }

  // Several draws of what judges: a view says little by a fifth of its bursts.
  Refiner::AgainstCloud against_cloud(const SearchGrid& grid, bool crowded, const Fit& fit) const {
    const VerdictOptions& o = options_.engine.verdict;
    Refiner::AgainstCloud sum, mean;
    std::vector<double> count(fit.pose.size(), 0.0);
    sum.structure.assign(count.size(), 0.0), sum.cloud.assign(count.size(), 0.0);
    // A template of hot spots asks for less noise than there is, and would then judge by blinks it has
    // fitted.
    NoiseModel splitting = fit.noise;
    splitting.lateral_factor = std::max(1.0, splitting.lateral_factor);
    splitting.axial_factor = std::max(1.0, splitting.axial_factor);
    for (int draw = 0; draw < o.draws; ++draw) {
      const Problems other =
          make_problems(views_, options_.engine.evidence,
                        options_.seed + kDrawSeed * static_cast<std::uint64_t>(draw + 1), splitting);
      const Refiner::AgainstCloud one =
          Refiner(other.of(crowded), grid, options_.engine).judge_against_cloud(fit);
      for (std::size_t i = 0; i < count.size(); ++i) {
        if (!std::isfinite(one.structure[i]) || !std::isfinite(one.cloud[i])) continue;
        sum.structure[i] += one.structure[i], sum.cloud[i] += one.cloud[i], ++count[i];
      }
      mean = sum;
      for (std::size_t i = 0; i < count.size(); ++i)
        mean.structure[i] /= count[i], mean.cloud[i] /= count[i];  // not a number where nothing judged
      if (over_cloud(mean.cloud, mean.structure, o).better_by(o.enough_standard_errors))
        break;  // beyond doubt
    }
    return mean;
  }

  // With the group against without; evidence decides which is the result.
  Fit tested(const Problem& problem, const Refiner& refiner, const std::string& name, Fit symmetric) {
    Fit plain = relaxed(problem, refiner, options_.engine, symmetric);
    const Comparison c = compare(symmetric.evidence, plain.evidence);
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
    out_.rounds = fit.rounds;
    out_.converged = fit.escaped <= options_.engine.refine.settled * static_cast<double>(problem.size());
    out_.stopped_because = std::to_string(fit.escaped) + " of " + std::to_string(problem.size()) +
                           " views moved by more than 15 degrees in the last search";
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
