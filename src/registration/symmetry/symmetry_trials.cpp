#include "symmetry_trials.hpp"

#include <algorithm>
#include <cmath>

#include "harmonics.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/symmetry_group.hpp"
#include "self_similarity.hpp"
#include "symmetry_frame.hpp"

namespace polar {

namespace {

// What looks alike under it and is no heptagon is alike under any turn.
constexpr const char* kAnyTurn = "C7";
// Most groups hold it, whichever of their axes comes to lie along z, so that from nothing it is found where a
// search under a larger group puts an axis across the structure's.
constexpr const char* kFromNothing = "D2";

struct Trial {
  std::string group;
  double similarity = 0;
  SoftState state;
  Evidence evidence;
};

std::size_t order_of(const std::string& group) {
  return std::max<std::size_t>(1, rotations_of(group).size());
}

bool is_cyclic(const std::string& group) { return group[0] == 'C' && group != "C1"; }

int fold_of(const std::string& group) { return std::stoi(group.substr(1)); }

void move_to(const Pose& canonical_from_template, SoftState& state) {
  const Eigen::Matrix3f r = canonical_from_template.rotation.cast<float>();
  const Eigen::Vector3f t = canonical_from_template.translation.cast<float>();
  const auto moved = [&](SoftPose& p) { p = {r * p.rotation, r * p.translation + t}; };
  for (auto& samples : state.sample) std::for_each(samples.begin(), samples.end(), moved);
  std::for_each(state.best.begin(), state.best.end(), moved);
}

class Trials {
 public:
  Trials(const Problem& problem, const RegistrationOptions& options, const SoftState& coarse)
      : problem_(problem),
        options_(options.engine),
        o_(options_.symmetry),
        annealer_(problem, evenly(problem.all, static_cast<std::size_t>(o_.views)), options_.anneal,
                  prior_of(options)),
        coarse_(coarse),
        similarity_(coarse.density, o_.similarity_blur),
        drawn_(problem) {
    // Poses of all views that take part, under the template of those that competed.
    annealer_.continue_under(stage(1), 1990, coarse_);
  }

  Trial plain(std::uint64_t key) { return run({"C1", {}, 1}, key); }

  /// From now on hints come from this template.
  void look_at(const Trial& trial) {
    coarse_ = trial.state;
    coarse_.group.clear();
    similarity_ = SelfSimilarity(coarse_.density, o_.similarity_blur);
  }

  /// Groups that the template hints at.
  std::vector<SymmetryFrame> hinted(const std::string& asked) {
    std::vector<SymmetryFrame> out;
    SymmetryFrame axial = best_frame(similarity_, kAnyTurn, o_.hint);
    // In the plane the axis is known, and a resolved template must not be moved to look alike under a wrong
    // turn.
    if (problem_.planar())
      axial.canonical_from_template = {Eigen::Matrix3d::Identity(), -similarity_.centroid()};
    const bool is_axial = problem_.planar() || axial.similarity >= o_.axial_hint;
    if (is_axial) {
      std::vector<SoftPose> pose = in_frame(axial.canonical_from_template).best;
      std::size_t taken = 0;
      for (const AxialHarmonic& h : axial_harmonics(problem_, o_, pose, annealer_.which())) {
        axial.group = "C" + std::to_string(h.order);
        // A trial in the plane costs next to nothing.
        const bool strong = problem_.planar() || (taken < static_cast<std::size_t>(o_.orders) &&
                                                  h.significance >= o_.least_significance);
        if (strong) ++taken;
        // Where no order stands out the two highest tell a body of revolution.
        const bool any_turn = taken == 0 && h.order >= o_.highest_order - 1;
        if (strong || any_turn || axial.group == asked) out.push_back(axial);
      }
    }
    std::vector<std::string> names;
    if (!is_axial)
      for (int n = 2; n <= o_.highest_order; ++n) names.push_back("C" + std::to_string(n));
    if (!problem_.planar()) names.insert(names.end(), {"T", "O", "I"});
    for (const std::string& name : names) {
      const SymmetryFrame f = best_frame(similarity_, name, o_.polyhedral_hint);
      // What looks more alike under any turn about an axis is no polyhedron.
      const double least = name[0] == 'C' ? o_.hint : std::max(o_.polyhedral_hint, axial.similarity);
      if (f.similarity >= least || name == asked) out.push_back(f);
    }
    const bool has = std::any_of(out.begin(), out.end(), [&](const auto& f) { return f.group == asked; });
    if (!asked.empty() && !has && asked[0] != 'D') out.push_back(best_frame(similarity_, asked, -INFINITY));
    return out;
  }

  Trial run(const SymmetryFrame& frame, std::uint64_t key) {
    SoftState state = in_frame(frame.canonical_from_template);
    if (is_cyclic(frame.group) && (problem_.planar() || frame.similarity >= o_.axial_hint)) {
      align_azimuths(problem_, fold_of(frame.group), annealer_.which(), state.best);
      for (const int i : annealer_.which()) {
        auto& samples = state.sample[static_cast<std::size_t>(i)];
        if (!samples.empty()) samples = {state.best[static_cast<std::size_t>(i)]};
      }
    }
    return annealed(frame.group, frame.similarity, std::move(state), key);
  }

  /// With two-fold axes across that of a cyclic group's trial.
  Trial dihedral(const Trial& cyclic, std::uint64_t key) {
    const std::string group = "D" + cyclic.group.substr(1);
    const SymmetryFrame f =
        best_frame(SelfSimilarity(cyclic.state.density, o_.similarity_blur), group, -INFINITY);
    SoftState state = cyclic.state;
    move_to(f.canonical_from_template, state);
    return annealed(group, f.similarity, std::move(state), key);
  }

  /// Random poses under the group: where labels are few and missing, a template without it has too few sites
  /// to hint at it.
  Trial from_nothing(const std::string& group, std::uint64_t key) {
    const AnnealOptions& a = options_.anneal;
    SoftState state = annealer_.random_start(key);
    state.group = rotations_of(group);
    annealer_.anneal({a.sweeps, a.first_width, a.last_width, a.first_beta, a.last_beta, a.narrowing, true},
                     key, state);
    return judged(group, 0, std::move(state), key);
  }

 private:
  AnnealStage stage(int sweeps) const {
    const AnnealOptions& a = options_.anneal;
    return {sweeps, o_.first_width, a.last_width, o_.first_beta, a.last_beta, o_.narrowing, false};
  }
  SoftState in_frame(const Pose& canonical_from_template) const {
    SoftState state = coarse_;
    move_to(canonical_from_template, state);
    return state;
  }
  Trial annealed(const std::string& group, double similarity, SoftState state, std::uint64_t key) {
    state.group = rotations_of(group);
    annealer_.anneal(stage(o_.sweeps), key, state);
    return judged(group, similarity, std::move(state), key);
  }
  Trial judged(const std::string& group, double similarity, SoftState state, std::uint64_t key) {
    const bool first = plain_.empty();  // C1 is
    const auto judge = [&] {
      Evidence evidence = annealer_.judge(state, key, drawn_);
      if (first) plain_.push_back(evidence);
      return evidence;
    };
    const auto lost = [&](const std::vector<Evidence>& drawn) {  // other draws would not make it free
      const auto as_many = plain_.begin() + static_cast<std::ptrdiff_t>(drawn.size());
      const Comparison c = compare(mean_over({plain_.begin(), as_many}), mean_over(drawn));
      return c.gain < -o_.means_standard_errors * c.standard_error;
    };
    Evidence evidence = over_draws(options_.evidence, o_.draws, drawn_, judge, lost);
    return {group, similarity, std::move(state), std::move(evidence)};
  }

  const Problem& problem_;
  const EngineOptions& options_;
  const SymmetryOptions& o_;
  SoftAnnealer annealer_;
  SoftState coarse_;
  SelfSimilarity similarity_;
  Problem drawn_;                // the problem, other bursts held out
  std::vector<Evidence> plain_;  // of C1 by every draw
};

std::size_t best_of(const std::vector<Trial>& trials) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < trials.size(); ++k)
    if (mean_evidence(trials[k].evidence) > mean_evidence(trials[best].evidence)) best = k;
  return best;
}

bool divides(int n, int m) { return m % n == 0; }

// Whether every turn of `inner` is one of `outer`, axes alike.
bool contains(const std::string& outer, const std::string& inner) {
  if (inner == "C1" || inner == outer) return true;
  const auto axial = [](const std::string& g) { return g[0] == 'C' || g[0] == 'D'; };
  if (!axial(outer) || !axial(inner)) return outer == "O" && inner == "T";
  return divides(fold_of(inner), fold_of(outer)) && (inner[0] == 'C' || outer[0] == 'D');
}

// Whether it costs no more against the best than the error of the evidence.
bool is_free(const Trial& trial, const Trial& best, const EngineOptions& options, bool posed) {
  // That a structure is symmetric at all is tested again on the exact template, so it may cost more here,
  // unless poses are known without it.
  const double tolerance = best.group != "C1" ? options.evidence.standard_errors
                           : posed            ? 0
                                              : options.symmetry.means_standard_errors;
  const Comparison c = compare(best.evidence, trial.evidence);
  // Few views do not say how much it costs: then it is not free.
  const double surely = c.gain - options.evidence.standard_errors * c.standard_error;
  return c.better_by(-tolerance) && surely > -options.symmetry.means_loss;
}

// The best one, and what contains it as long as that is free.
std::size_t largest_free(const std::vector<Trial>& trials, const EngineOptions& options, bool posed) {
  const std::size_t best = best_of(trials);
  std::size_t chosen = best;
  for (bool grown = true; grown;) {
    grown = false;
    std::size_t next = chosen;
    for (std::size_t k = 0; k < trials.size(); ++k)
      if (k != chosen && contains(trials[k].group, trials[chosen].group) &&
          is_free(trials[k], trials[best], options, posed) &&
          (next == chosen || mean_evidence(trials[k].evidence) > mean_evidence(trials[next].evidence)))
        next = k;
    if (next != chosen) chosen = next, grown = true;
  }
  return chosen;
}

const Trial* named(const std::vector<Trial>& trials, const std::string& group) {
  const auto at =
      std::find_if(trials.begin(), trials.end(), [&](const Trial& t) { return t.group == group; });
  return at == trials.end() ? nullptr : &*at;
}

}  // namespace

RotationGroup rotations_of(const std::string& group) {
  return group == "C1" || group.empty() ? RotationGroup{} : symmetry_rotations(group);
}

SymmetryChoice choose_symmetry(const Problem& problem, const RegistrationOptions& options,
                               const SoftState& coarse, const std::string& asked, bool posed,
                               Progress& progress) {
  const SymmetryOptions& o = options.engine.symmetry;
  SymmetryChoice out{"C1", coarse, {}, {}, false};
  Trials all(problem, options, coarse);
  const bool asked_dihedral = !asked.empty() && asked[0] == 'D';
  const std::string cyclic = asked_dihedral ? "C" + asked.substr(1) : asked;
  std::vector<Trial> trials;
  std::uint64_t key = 2000;
  const auto add = [&](Trial t) {
    trials.push_back(std::move(t));
    ++key;
    progress.step("symmetry", static_cast<int>(trials.size()), static_cast<int>(trials.size()) + 1);
  };
  add(all.plain(key));
  if (!problem.planar() && !posed) {
    // A template without any group may have spots too bright to hint at its axes.
    add(all.from_nothing(kFromNothing, key));
    if (compare(trials[0].evidence, trials[1].evidence).better_by(0)) all.look_at(trials[1]);
  }
  for (const SymmetryFrame& f : all.hinted(cyclic)) {
    if (progress.cancelled()) return out;
    add(all.run(f, key));
  }
  if (!problem.planar()) {
    // Across every axis that is free, since a cyclic group alone hardly tells orders apart, and across one
    // that was asked for.
    const std::size_t cyclic_trials = trials.size(), best = best_of(trials);
    const bool axis_found = is_cyclic(trials[largest_free(trials, options.engine, posed)].group);
    for (std::size_t t = 0; axis_found && t < cyclic_trials && !progress.cancelled(); ++t)
      if (is_cyclic(trials[t].group) &&
          (t == best || is_free(trials[t], trials[best], options.engine, posed)))
        add(all.dihedral(trials[t], key));
    if (asked_dihedral && named(trials, asked) == nullptr) add(all.dihedral(*named(trials, cyclic), key));
  }
  if (!problem.planar() && asked.empty() && !posed &&
      trials[largest_free(trials, options.engine, posed)].group == "C1")
    for (const char* group : {"T", "O", "I"}) {
      if (progress.cancelled()) return out;
      add(all.from_nothing(group, key));
    }
  const std::size_t k = largest_free(trials, options.engine, posed);
  const Trial& chosen = asked.empty() ? trials[k] : *named(trials, asked);
  const Evidence& plain = trials.front().evidence;
  for (const Trial& t : trials) {
    if (t.group == "C1") continue;
    const Comparison c = compare(plain, t.evidence);
    out.report.tried.push_back({t.group, t.similarity, c.gain, c.standard_error});
  }
  std::stable_sort(out.report.tried.begin(), out.report.tried.end(),
                   [](const auto& a, const auto& b) { return order_of(a.group) > order_of(b.group); });
  const Comparison c = compare(plain, chosen.evidence);
  out.group = chosen.group;
  out.state = chosen.state;
  const std::size_t best = best_of(trials);
  for (std::size_t t = 1; asked.empty() && out.group != "C1" && t < trials.size(); ++t)
    if (!contains(trials[t].group, out.group) && !contains(out.group, trials[t].group) &&
        is_free(trials[t], trials[best], options.engine, posed))
      out.rival.push_back({trials[t].group, trials[t].state});
  out.report.asked = !asked.empty();
  out.report.group = out.group;
  out.report.gain = c.gain, out.report.gain_std = c.standard_error;
  const bool highest = out.group.substr(1) == std::to_string(o.highest_order);
  const Trial* lower = named(trials, "C" + std::to_string(o.highest_order - 1));
  out.continuous = asked.empty() && highest && lower != nullptr &&
                   compare(trials[best_of(trials)].evidence, lower->evidence)
                       .better_by(-options.engine.evidence.standard_errors);
  return out;
}

}  // namespace polar
