// One loop: coarse hypotheses compete, the symmetry of the best is tried, the exact template is refined, its
// symmetry tested against doing without, and what came of it is reported.
#include "polar/registration/register.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "data/template_tools.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/symmetry_group.hpp"
#include "proposals/compete.hpp"
#include "proposals/latent_method.hpp"
#include "proposals/polar_start.hpp"
#include "account/report.hpp"
#include "account/verdict.hpp"
#include "smlm/error.hpp"
#include "states.hpp"
#include "symmetry/relaxation.hpp"
#include "symmetry/symmetry_trials.hpp"
#include "symmetry/symmetry_units.hpp"

namespace polar {

namespace {

constexpr std::uint64_t kDrawSeed = 7919;  // between the draws of what judges the verdict
constexpr double kLargestFactor = 1.5;  // of a, either way, before a warning

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return s;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
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
                      "'" + options.symmetry + "' is not a group of planar data", "use auto, none, detect or C<n>");
}

std::vector<Pose> poses_of(const std::vector<SoftPose>& soft) {
  std::vector<Pose> out;
  for (const SoftPose& p : soft) out.push_back({p.rotation.cast<double>(), p.translation.cast<double>()});
  return out;
}

class Run {
 public:
  Run(const Views& views, const RegistrationOptions& options, Progress& progress, Checkpoint& checkpoint)
      : options_(options), problems_(make_problems(views, options.engine.evidence, options.seed)),
        progress_(progress), checkpoint_(checkpoint) {
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
  void timed(const char* stage) { out_.timings.push_back({stage, watch_.lap()}); }
  Registration cancelled() {
    out_.stopped_because = "cancelled";
    out_.verdict_reason = "cancelled";
    return std::move(out_);
  }

  // Coarse poses of all views and the group they are under.
  bool find(CoarseState& coarse) {
    const LatentModel model = latent_model(options_);
    Competition found = compete(problems_, model.autoencoder.get(), options_, progress_);
    timed("starts");
    if (!found.finished) return false;
    coarse.crowded = found.crowded;
    coarse.starts = std::move(found.report);
    coarse.agreement = found.agreement;
    coarse.weights_sha256 = model.weights_sha256;
    const Problem& problem = problems_.of(coarse.crowded);
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
    const SoftAnnealer all(problem, problem.all, a,
                           {options_.tilt_deg * kRadiansPerDegree, options_.flip});
    all.continue_under({a.last_sweeps, a.last_width, a.last_width, a.last_beta, a.last_beta, 1, false}, 4000,
                       state);
    coarse.pose = poses_of(state.best);
    timed("all views");
    return !progress_.cancelled();
  }

  Registration finish(CoarseState coarse) {
    const Problem& problem = problems_.of(coarse.crowded);
    RefineOptions refine = options_.engine.refine;
    if (options_.search == "exhaustive") {
      refine.rotations = kExhaustiveRotations;
      refine.planar_rotations = kExhaustivePlanarRotations;
    }
    const RotationGroup group = rotations_of(coarse.group);
    const SearchGrid grid =
        search_grid(problem.planar() ? refine.planar_rotations : refine.rotations, problem.planar(), group);
    const Refiner refiner(problem, grid, refine);
    FineState fine;
    if (!restore(checkpoint_, "fine", fine)) {
      fine.fit = refiner.begin(std::move(coarse.pose), NoiseModel{}, group);
      fine.fit = refiner.rounds(std::move(fine.fit), progress_);
      timed("rounds");
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
    const Refiner::AgainstCloud against = against_cloud(grid, refine, coarse.crowded, fit);
    timed("verdict");
    report_views(problem, options_.engine, fit, out_);
    timed("polish");
    judge_registration(against.cloud, against.structure, options_.engine.verdict, out_);
    conclude(problem, coarse, fit);
    return std::move(out_);
  }

  // Several draws of what judges: a view says little by a fifth of its bursts.
  Refiner::AgainstCloud against_cloud(const SearchGrid& grid, const RefineOptions& refine, bool crowded,
                                      const Fit& fit) const {
    Refiner::AgainstCloud sum;
    std::vector<double> count(fit.pose.size(), 0.0);
    sum.structure.assign(count.size(), 0.0), sum.cloud.assign(count.size(), 0.0);
    for (int draw = 0; draw < options_.engine.verdict.draws; ++draw) {
      const Problems other = make_problems(problems_.plain.views, options_.engine.evidence,
                                           options_.seed + kDrawSeed * static_cast<std::uint64_t>(draw + 1));
      const Refiner::AgainstCloud one = Refiner(other.of(crowded), grid, refine).judge_against_cloud(fit);
      for (std::size_t i = 0; i < count.size(); ++i) {
        if (!std::isfinite(one.structure[i]) || !std::isfinite(one.cloud[i])) continue;
        sum.structure[i] += one.structure[i], sum.cloud[i] += one.cloud[i], ++count[i];
      }
    }
    for (std::size_t i = 0; i < count.size(); ++i)
      sum.structure[i] /= count[i], sum.cloud[i] /= count[i];  // not a number where nothing judged
    return sum;
  }

  // With the group against without; evidence decides which is the result.
  Fit tested(const Problem& problem, const Refiner& refiner, const std::string& name, Fit symmetric) {
    Fit plain = relaxed(problem, refiner, options_.engine, symmetric);
    const Comparison c = compare(symmetric.evidence, plain.evidence);
    const bool without = c.better_by(options_.engine.evidence.standard_errors) && !names_a_group(options_.symmetry);
    if (out_.symmetry) out_.symmetry->in_use = !without;
    const double sign = without ? -1 : 1;
    out_.other = OtherTemplate{without ? name : "C1", fused_template(without ? symmetric : plain), sign * c.gain,
                               c.standard_error};
    return without ? std::move(plain) : std::move(symmetric);
  }

  void conclude(const Problem& problem, const CoarseState& coarse, const Fit& fit) {
    out_.starts = coarse.starts;
    out_.agreement = coarse.agreement;
    out_.weights_sha256 = coarse.weights_sha256;
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
      out_.warnings.push_back("registration.symmetry: " + s.group + " explains localisations kept apart worse than " +
                              best->group + " does, by " + text(best->gain - s.gain) + " nat each");
    if (s.gain < -s.gain_std)
      out_.warnings.push_back("registration.symmetry: " + s.group +
                              " explains localisations kept apart worse than no symmetry does, by " +
                              text(-s.gain) + " +- " + text(s.gain_std) + " nat each");
  }

  const RegistrationOptions& options_;
  Problems problems_;
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
    out.timings.push_back({"latent", watch.lap()});
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
