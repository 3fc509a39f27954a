#include "polar/registration/register.hpp"

#include <algorithm>
#include <chrono>
#include <set>

#include "finish.hpp"
#include "latent_method.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar_start.hpp"
#include "self_similarity.hpp"
#include "smlm/error.hpp"
#include "starts.hpp"
#include "states.hpp"
#include "structureless.hpp"
#include "symmetry_stage.hpp"
#include "symmetry_units.hpp"

namespace polar {

namespace {

constexpr double kFewLocalisations = 12000;  // of all views: less, and the last search is done again
constexpr int kMostLastSearches = 3;
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
  const auto far = [](double a) { return a > kLargestFactor || a < 1 / kLargestFactor; };
  const auto warn = [&](const char* axis, double a) {
    if (far(a))
      warnings.push_back(std::string("the ") + axis +
                         " uncertainties of the table do not describe its noise: the data want them times " +
                         std::to_string(a).substr(0, 4) + "; the calibrated ones were used");
  };
  warn("lateral", c.lateral_factor);
  if (c.axial_factor != c.lateral_factor) warn("axial", c.axial_factor);
}

// Everything a run carries from stage to stage.
struct Run {
  Run(const Views& views, const RegistrationOptions& options, Progress& p, Checkpoint& c)
      : problems(make_problems(views, options.seed)), progress(p), checkpoint(c) {
    out.view.resize(views.view.size());
    if (options.search == "exhaustive") {
      rounds.rotations = kExhaustiveRotations;
      rounds.planar_rotations = kExhaustivePlanarRotations;
    }
    grid = search_grid(views.planar ? rounds.planar_rotations : rounds.rotations, views.planar);
    timed("grid");
  }
  void timed(const char* stage) { out.timings.push_back({stage, watch.lap()}); }

  Problems problems;
  Progress& progress;
  Checkpoint& checkpoint;
  Stopwatch watch;
  RoundOptions rounds;
  SearchGrid grid;
  Registration out;
};

bool imposes(const RegistrationOptions& options) {
  return options.symmetry != "none" && options.symmetry != "detect";
}

Registration cancelled(Run& run) {
  run.out.stopped_because = "cancelled";
  return std::move(run.out);
}

// Calibration and everything else that is decided before the polish. False: cancelled.
bool fuse(Run& run, const RegistrationOptions& options, FusedState& fused) {
  auto& [state, noise] = fused;
  const Problem& problem = run.problems.of(state.crowded);
  noise.planar = problem.planar();
  noise.width = state.width;
  noise = calibrate_and_fuse(problem, 3, noise, state);
  run.timed("calibration");
  if (run.progress.cancelled()) return false;
  CalibrationReport chosen = choose_centres(problem, noise, state);
  noise = chosen.noise;
  run.timed("centres");
  if (run.progress.cancelled()) return false;
  if (imposes(options)) {
    run.out.symmetry = impose_symmetry(problem, noise, options.symmetry, state);
    noise = calibrate_and_fuse(problem, 1, noise, state);
    chosen = choose_centres(problem, noise, state);
    noise = chosen.noise;
    run.timed("symmetry");
  }
  state.structureless = explains_no_more_than_a_cloud(problem, chosen.log_likelihood);
  // A few localisations fit noise at first, and each view that is set right sharpens the template.
  const int searches = std::clamp(static_cast<int>(kFewLocalisations / std::max(1.0, problem.localisations)),
                                  1, kMostLastSearches);
  for (int k = 0; k < searches && (k == 0 || state.escaped > 0); ++k, ++state.rounds) {
    const std::vector<Pose> before = state.pose;
    std::vector<std::size_t> escaped =
        search_all(problem, run.grid, run.rounds, noise, problem.shuffled, state);
    for (const std::size_t i : search_misfits(problem, run.grid, run.rounds, noise, state))
      if (std::find(escaped.begin(), escaped.end(), i) == escaped.end()) escaped.push_back(i);
    state.escaped = static_cast<int>(escaped.size());
    state.twins = twins(state.mixture, problem.planar(), before, state.pose, escaped);
    noise = calibrate_and_fuse(problem, 1, noise, state);
  }
  if (state.sites) noise = choose_centres(problem, noise, state).noise;
  run.timed("last search");
  return true;
}

// From a registered template to the result.
Registration from_state(Run& run, const RegistrationOptions& options, RoundState registered) {
  // What is found about an imposed group is no part of the state: those runs fuse again.
  const bool kept = !imposes(options);
  FusedState fused;
  if (!kept || !restore(run.checkpoint, "fused", fused)) {
    fused.state = std::move(registered);
    if (!fuse(run, options, fused)) return cancelled(run);
    if (kept) keep(run.checkpoint, "fused", fused);
  }
  if (run.progress.cancelled()) return cancelled(run);
  auto& [state, noise] = fused;
  const Problem& problem = run.problems.of(state.crowded);
  if (options.symmetry == "detect") {
    run.out.symmetry = detect_symmetry(problem, noise, state);
    run.timed("symmetry");
  }
  polish_all(problem, noise, state, run.out);
  run.timed("polish");
  Registration& out = run.out;
  out.rounds = state.rounds;
  out.converged = state.escaped - state.twins <= run.rounds.settled * static_cast<double>(problem.size());
  out.stopped_because = std::to_string(state.escaped) + " of " + std::to_string(problem.size()) +
                        " views moved by more than 15 degrees in the last search";
  if (state.twins > 0)
    out.stopped_because +=
        ", " + std::to_string(state.twins) + " of them to where the template looks the same";
  warn_about_calibration(out.calibration, out.warnings);
  if (out.symmetry) {
    count_units(problem, out);
    const std::string warning = symmetry_warning(*out.symmetry);
    if (!warning.empty()) out.warnings.push_back(warning);
  }
  return std::move(out);
}

void check_symmetry(const RegistrationOptions& options, std::vector<std::string>& faults) {
  if (options.symmetry == "none") return;
  if (options.symmetry != "detect" &&
      (!is_symmetry_group(options.symmetry) || options.symmetry == "C1" || options.symmetry == "D1"))
    faults.push_back("registration.symmetry: '" + options.symmetry +
                     "' is none of none, detect, C<n> or D<n> (n from 2 to 360), T, O, I");
  if (options.method == "latent")
    faults.push_back("registration.symmetry: '" + options.symmetry +
                     "' needs registration.method: likelihood");
}

// Only the table tells whether the data are planar.
void check_planar(const Views& views, const RegistrationOptions& options) {
  if (views.planar && imposes(options) && options.symmetry[0] != 'C')
    throw smlm::Error(smlm::Fault::usage, "registration.symmetry",
                      "'" + options.symmetry + "' is not a group of planar data", "use none, detect or C<n>");
}

}  // namespace

std::vector<std::string> violations(const RegistrationOptions& options) {
  std::vector<std::string> faults;
  if (options.starts.empty())
    faults.push_back("registration.starts: at least one of polar, random, imaged, assembled is needed");
  for (const std::string& s : options.starts)
    if (s != "polar" && s != "random" && s != "imaged" && s != "assembled")
      faults.push_back("registration.starts: '" + s + "' is none of polar, random, imaged, assembled");
  if (std::set<std::string>(options.starts.begin(), options.starts.end()).size() != options.starts.size())
    faults.push_back("registration.starts: a start is named twice");
  if (options.search != "fast" && options.search != "exhaustive")
    faults.push_back("registration.search: '" + options.search + "' is neither fast nor exhaustive");
  if (options.method != "likelihood" && options.method != "latent")
    faults.push_back("registration.method is '" + options.method + "', neither likelihood nor latent");
  LatentOptions latent = options.latent;
  latent.optimizer = options.optimizer;
  for (const std::string& v : violations(latent)) faults.push_back("registration." + v);
  check_symmetry(options, faults);
  return faults;
}

bool wants(const RegistrationOptions& options, const std::string& start) {
  return std::find(options.starts.begin(), options.starts.end(), start) != options.starts.end();
}

bool needs_weights(const RegistrationOptions& options) {
  return options.method == "latent" || wants(options, "polar");
}

Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress) {
  Checkpoint nothing;
  return register_views(views, options, progress, nothing);
}

Registration register_views(const Views& views, const RegistrationOptions& options, Progress& progress,
                            Checkpoint& checkpoint) {
  check_planar(views, options);
  LatentModel model = latent_model(options);
  if (options.method == "latent") {
    Stopwatch watch;
    Registration out =
        latent_method(make_problems(views, options.seed).plain, *model.autoencoder, options, progress);
    out.weights_sha256 = std::move(model.weights_sha256);
    out.timings.push_back({"latent", watch.lap()});
    return out;
  }
  Run run(views, options, progress, checkpoint);
  StartsOutcome starts;
  if (!restore(checkpoint, "winner", starts)) {
    starts =
        compete(run.problems, model.autoencoder.get(), options, run.grid, run.rounds, progress, checkpoint);
    run.timed("starts");
    if (!starts.finished) return cancelled(run);
    checkpoint.drop("start "), checkpoint.drop("finalist ");
    keep(checkpoint, "winner", starts);
  }
  run.out.starts = starts.report;
  run.out.agreement = starts.agreement;
  run.out.weights_sha256 = std::move(model.weights_sha256);
  return from_state(run, options, std::move(starts.winner));
}

Registration register_from(const Views& views, const std::vector<Pose>& template_from_view,
                           const RegistrationOptions& options, Progress& progress) {
  check_planar(views, options);
  Checkpoint nothing;
  Run run(views, options, progress, nothing);
  RoundState state;
  state.pose = template_from_view;
  fuse_anew(run.problems.thinned, run.rounds, run.problems.thinned.all, state);
  if (!run_rounds(run.problems.thinned, run.grid, run.rounds, progress, nothing, state))
    return cancelled(run);
  run.timed("rounds");
  return from_state(run, options, std::move(state));
}

}  // namespace polar
