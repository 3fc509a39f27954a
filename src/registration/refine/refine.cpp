#include "refine.hpp"

#include <algorithm>
#include <cmath>

#include "../data/template_tools.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/fusion/calibration.hpp"
#include "polar/fusion/discretise.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/search_again.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kTurnStage = 31, kCloudStage = 33;
// Of a template turned any way: its shells err by a few per cent.
constexpr Eigen::Index kCloudCentres = 12000;
constexpr double kMoved = 2 * kRadiansPerDegree;
constexpr double kPooled = 2;      // spreads of a centre, within which a view tells centres apart no better
constexpr int kJudgingSweeps = 2;  // without the held-out localisations, before they judge

int centres_for(const Problem& problem, const RefineOptions& o) {
  return std::clamp(static_cast<int>(problem.localisations / o.localisations_per_centre), o.fewest_centres,
                    o.most_centres);
}

// The template's width raised so far that it is drawn no sharper than `width`, together with what noise adds.
void draw_no_sharper_than(double width, NoiseModel& noise) {
  noise.width = std::sqrt(
      std::max(noise.width * noise.width, width * width - noise.lateral_extra * noise.lateral_extra));
}

double spread(const NoiseModel& noise) { return std::hypot(noise.width, noise.lateral_extra); }

}  // namespace

void show(const Fit& fit, const Mixture& mixture, FusionData& data) {
  if (std::isfinite(fit.occupancy))
    data.set_visibility(occupancy(mixture, data, fit.pose, fit.occupancy, kPooled * spread(fit.noise)));
}

Fit Refiner::begin(std::vector<Pose> pose, const NoiseModel& noise, const RotationGroup& group) const {
  Fit fit;
  fit.pose = std::move(pose);
  fit.noise = noise;
  fit.noise.planar = problem_.planar();
  fit.noise.width = options_.first_width;
  fit.group = group;
  fit.margin.assign(problem_.size(), INFINITY);
  const Subsets few = first_of(problem_.sampled, static_cast<std::size_t>(options_.localisations));
  const int wanted =
      centres_for(problem_, options_) / static_cast<int>(std::max<std::size_t>(1, group.size()));
  fit.mixture =
      scattered_mixture(problem_, few, problem_.all, fit.pose, std::max(wanted, options_.fewest_of_unit), 1);
  if (!group.empty()) fit.mixture = symmetrised(fit.mixture, group, 0.5 * options_.first_width);
  sweep(few, fit, 2 * options_.sweeps);
  return fit;
}

void Refiner::sweep(const Subsets& subsets, Fit& fit, int sweeps) const {
  FusionData data(problem_.views, problem_.axes, fit.noise, subsets);
  for (int s = 0; s < sweeps; ++s) {
    MaximisationOptions em;
    em.reseed_distance = 0.5 * std::max(fit.noise.width, 0.02);
    em.seed = problem_.seed + static_cast<std::uint64_t>(100 * fit.rounds + s);
    em.group = fit.group;
    em.free_weights = true;
    em.support = problem_.crowded || !fit.group.empty();
    show(fit, fit.mixture, data);
    maximise(fit.mixture, data, fit.pose, em);
    if (s == 0) continue;
    show(fit, fit.mixture, data);
    refine_poses(fit.mixture, data, fit.pose, 2);
  }
}

void Refiner::sweep(Fit& fit, int sweeps) const {
  sweep(first_of(problem_.sampled, static_cast<std::size_t>(options_.localisations)), fit, sweeps);
}

void Refiner::search(Fit& fit) const { search(problem_.sampled, fit); }

void Refiner::search(const Subsets& subsets, Fit& fit) const {
  NoiseModel noise = fit.noise;
  draw_no_sharper_than(options_.search_width, noise);
  SearchAgainOptions o;
  o.basins = options_.basins;
  o.lookup_doubt = options_.lookup_doubt;
  o.group = fit.group;
  o.most_localisations = options_.search_localisations;
  o.grid.translation = axis_shifts(
      static_cast<float>(problem_.planar() ? options_.planar_shift : options_.shift), problem_.planar());
  o.grid.promising = options_.promising;
  o.grid.step = static_cast<float>(options_.step);
  const Eigen::Matrix3f turn =
      grid_turn(problem_.planar(),
                KeyedRandom(problem_.seed, static_cast<std::uint64_t>(fit.rounds), kTurnStage), grid_.prior);
  SearchAgainReport report =
      search_again(problem_.views, problem_.axes, subsets, fit.mixture, noise, grid_, turn, o, fit.pose);
  fit.margin = std::move(report.margin);
  fit.escaped = static_cast<int>(report.escaped.size());
  ++fit.rounds;
}

// Template and poses without the held-out localisations.
Fit Refiner::blind(Fit fit) const {
  // A label that judges is missing in what was fitted.
  fit.occupancy = std::numeric_limits<double>::infinity();
  sweep(first_of(problem_.fitted, static_cast<std::size_t>(options_.localisations)), fit, kJudgingSweeps);
  return fit;
}

Evidence Refiner::held_out(const Fit& fit) const {
  const FusionData data(problem_.views, problem_.axes, fit.noise, problem_.held_out);
  Evidence evidence = mean_log_likelihood(fit.mixture, data, fit.pose);
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (problem_.held_out[i].empty()) evidence[i] = NAN;
  return evidence;
}

Refiner::AgainstCloud Refiner::judge_against_cloud(Fit fit) const {
  // A structure that is there shows at the first width already; the last one is as fine as all views allow.
  draw_no_sharper_than(options_.first_width, fit.noise);
  fit = blind(std::move(fit));
  search(problem_.fitted, fit);
  fit = blind(std::move(fit));
  Fit cloud = fit;
  const Mixture& m = fit.mixture;
  const Eigen::Index turns =
      std::clamp(kCloudCentres / std::max<Eigen::Index>(1, m.size()), Eigen::Index{8}, Eigen::Index{256});
  const Eigen::Vector3d centre = m.centre.cast<double>() * m.weight.cast<double>();
  Mixture turned = m;
  turned.centre.resize(3, turns * m.size());
  turned.weight.resize(turns * m.size());
  KeyedRandom random(problem_.seed, 0, kCloudStage);
  for (Eigen::Index t = 0; t < turns; ++t) {
    const Eigen::Matrix3d r =
        problem_.planar() ? so3_exp({0, 0, kTwoPi * random.uniform()}) : random.rotation();
    const Eigen::Vector3f shift = (centre - r * centre).cast<float>();
    turned.centre.middleCols(t * m.size(), m.size()) = (r.cast<float>() * m.centre).colwise() + shift;
    turned.weight.segment(t * m.size(), m.size()) = m.weight / static_cast<float>(turns);
  }
  sort_into_blocks(turned);
  cloud.mixture = std::move(turned);
  return {held_out(fit), held_out(cloud)};
}

Fit Refiner::rounds(Fit fit, Progress& progress) const {
  const int total = 1 + static_cast<int>(std::ceil(std::log(options_.last_width / options_.first_width) /
                                                   std::log(options_.narrowing)));
  Fit best = fit;
  bool searching = true;
  for (int round = 0; round < total && !progress.cancelled(); ++round) {
    const std::vector<Pose> before = fit.pose;
    const bool searched = searching && round < options_.most_searches;
    fit.noise.width =
        std::max(options_.last_width, options_.first_width * std::pow(options_.narrowing, round));
    if (searched) {
      search(fit);
      searching = round == 0 || fit.escaped > options_.settled * static_cast<double>(problem_.size());
    }
    if (round == 0) {  // the views that were turned far say where centres are missing
      const int searches = fit.rounds, escaped = fit.escaped;
      std::vector<double> margin = std::move(fit.margin);
      fit = begin(std::move(fit.pose), fit.noise, fit.group);
      fit.rounds = searches, fit.escaped = escaped, fit.margin = std::move(margin);
    } else {
      sweep(fit, options_.sweeps);
    }
    judge_round(before, searched, fit);
    progress.step("registering", round + 1, total);
    if (round == 0 || compare(best.evidence, fit.evidence).better_by(0))
      best = fit;
    else if (!searching)
      break;
  }
  best.history = std::move(fit.history);  // also of what came after and was no better
  return best;
}

Fit Refiner::last_round(Fit fit) const {
  const std::vector<Pose> before = fit.pose;
  search(fit);
  sweep(fit, options_.sweeps);
  judge_round(before, true, fit);
  return fit;
}

void Refiner::judge_round(const std::vector<Pose>& before, bool searched, Fit& fit) const {
  fit.evidence = judge(fit);
  RoundReport report;
  report.width = spread(fit.noise);
  for (std::size_t i = 0; i < before.size(); ++i)
    report.moved += angle_modulo(fit.group, before[i].rotation, fit.pose[i].rotation) > kMoved;
  if (searched) report.escaped = fit.escaped;
  report.held_out_log_likelihood = mean_evidence(fit.evidence);
  fit.history.push_back(report);
}

Fit Refiner::narrowed(Fit fit) const {
  while (fit.noise.width * options_.narrowing >= options_.last_width) {
    Fit next = fit;
    next.noise.width *= options_.narrowing;
    sweep(next, options_.sweeps);
    next.evidence = judge(next);
    if (!compare(fit.evidence, next.evidence).better_by(0)) break;
    fit = std::move(next);
  }
  return fit;
}

Fit Refiner::discrete(Fit fit) const {
  const double finest = std::max(spread(fit.noise), options_.last_width / 2);
  for (const double factor : {1.0, 2.0, 4.0}) {
    Fit next = fit;
    next.mixture = fit.group.empty() ? merged(fit.mixture, factor * finest)
                                     : symmetrised(fit.mixture, fit.group, factor * finest);
    if (next.mixture.size() >= fit.mixture.size()) continue;
    sweep(next, 2 * options_.sweeps);
    next.evidence = judge(next);
    if (!compare(fit.evidence, next.evidence).better_by(-standard_errors_)) break;
    fit = std::move(next);
  }
  const FusionData data(problem_.views, problem_.axes, fit.noise, problem_.sampled);
  fit.occupancy = likeliest_strength(fit.mixture, data, fit.pose, kPooled * spread(fit.noise));
  return fit;
}

// A template fitted under too much noise is too sharp to tell that there is less of it, so that every
// proposal gets a template of its own.
Fit Refiner::with_noise(Fit fit) const {
  struct Way {
    double lateral, axial, width;  // of the logarithms of the factors and of the width, in steps
  };
  std::vector<Way> ways = {{-1, -1, 0}, {-1, -1, 1}, {0, 0, 1}, {1, 1, 0}};
  if (has_axial_noise(problem_.views, problem_.axes))
    ways.insert(ways.end(), {{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}});
  fit.evidence = judge(fit);
  fit =
      narrowed(std::move(fit));  // or a template that is too wide would be taken for noise that is overstated
  int tries = 0;
  std::size_t failed = 0;  // ways in a row
  for (std::size_t w = 0; failed < ways.size() && tries < options_.noise_tries; ++tries) {
    Fit next = fit;
    next.noise.lateral_factor *= std::pow(options_.noise_step, ways[w].lateral);
    next.noise.axial_factor *= std::pow(options_.noise_step, ways[w].axial);
    next.noise.width *= std::pow(options_.noise_step, ways[w].width);
    sweep(next, options_.sweeps);
    next.evidence = judge(next);
    if (compare(fit.evidence, next.evidence).better_by(standard_errors_)) {
      fit = std::move(next);
      failed = 0;
    } else {
      ++failed;
      w = (w + 1) % ways.size();
    }
  }
  return fit;
}

Fit Refiner::calibrated(Fit fit) const {
  const Subsets fitted = first_of(problem_.fitted, static_cast<std::size_t>(options_.localisations));
  for (int c = 0; c < options_.calibrations; ++c) {
    Fit next = fit, blind = fit;
    sweep(fitted, blind, kJudgingSweeps);
    next.noise =
        calibrate(problem_.views, problem_.axes, problem_.held_out, blind.mixture, blind.pose, fit.noise)
            .noise;
    sweep(next, options_.sweeps);
    next.evidence = judge(next);
    if (!compare(fit.evidence, next.evidence).better_by(0)) break;
    fit = std::move(next);
  }
  return fit;
}

}  // namespace polar
