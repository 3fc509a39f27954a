#include "soft_poses.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "../data/template_tools.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/symmetry_group.hpp"
#include "polar/flames/rotation_grid.hpp"
#include "pose_scorer.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kStartStage = 21, kGridStage = 23, kPoseStage = 24;
constexpr std::size_t kDepositViews = 64;  // of one block of counts

double geometric(double first, double last, double t) { return first * std::pow(last / first, t); }

LookupPoints lookup_points(const View& view, const std::vector<std::uint32_t>& subset, std::size_t most) {
  LookupPoints out;
  for (std::size_t k = 0; k < std::min(most, subset.size()); ++k)
    out.add(view.points.col(static_cast<Eigen::Index>(subset[k])));
  out.pad();
  return out;
}

// `count` points of a random order, from a random place in it on.
LookupPoints some_of(const LookupPoints& all, std::size_t count, KeyedRandom& random) {
  const auto n = static_cast<std::size_t>(all.count);
  if (count >= n) return all;
  const std::size_t first = random.below(n);
  LookupPoints out;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t j = (first + k) % n;
    out.add({all.x[j], all.y[j], all.z[j]});
  }
  out.pad();
  return out;
}

LookupPoints first_of(const LookupPoints& all, int count) {
  if (count >= all.count) return all;
  LookupPoints out = all;
  out.count = count;
  for (auto* a : {&out.x, &out.y, &out.z}) a->resize(static_cast<std::size_t>(count));
  out.pad();
  return out;
}

float angle_between(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  const float c = 0.5f * (a.cwiseProduct(b).sum() - 1);
  return std::acos(std::clamp(c, -1.0f, 1.0f));
}

Eigen::Vector3f normal3(KeyedRandom& random, double scale, bool flat) {
  Eigen::Vector3f v;
  for (int a = 0; a < 3; ++a) v[a] = static_cast<float>(scale * random.normal());
  if (flat) v[2] = 0;
  return v;
}

}  // namespace

std::vector<SoftPose> soft_poses_of(const std::vector<Pose>& pose) {
  std::vector<SoftPose> out;
  for (const Pose& p : pose) out.push_back({p.rotation.cast<float>(), p.translation.cast<float>()});
  return out;
}

AnnealStage growth_stage(const EngineOptions& options) {
  const ProposalOptions& p = options.proposals;
  const AnnealOptions& a = options.anneal;
  return {p.regrown_sweeps, p.regrown_width, a.last_width, p.regrown_beta, a.last_beta, a.narrowing, false};
}

struct SoftAnnealer::Draw {
  SoftPose pose;
  float score = 0;  // log likelihood of the points looked at, prior included
  double weight = 0;
  static bool better(const Draw& a, const Draw& b) { return a.score > b.score; }
};

SoftAnnealer::SoftAnnealer(const Problem& problem, std::vector<int> which, const AnnealOptions& options,
                           const PosePrior& prior)
    : problem_(problem),
      which_(std::move(which)),
      options_(options),
      prior_(prior),
      frame_(options.reach, problem.planar() ? options.planar_voxel : options.voxel, problem.planar()),
      all_(points_of(problem.sampled, options.most_localisations)) {
  // The centroid of few labels lies anywhere about that of the structure.
  for (const std::vector<int>& burst : problem.burst) {
    const int labels = burst.empty() ? 1 : 1 + *std::max_element(burst.begin(), burst.end());
    shift_.push_back(std::hypot(options.shift, options.shift_of_label / std::sqrt(labels)));
  }
}

SoftAnnealer::Points SoftAnnealer::points_of(const Subsets& subsets, int most) const {
  Points out(problem_.size());
  parallel_for(which_.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which_[k]);
    out[i] = lookup_points(problem_.views.view[i], subsets[i], static_cast<std::size_t>(most));
  });
  return out;
}

SoftState SoftAnnealer::random_start(std::uint64_t key) const {
  SoftState state(frame_);
  state.outlier_fraction = options_.first_outlier_fraction;
  state.sample.resize(problem_.size());
  state.best.resize(problem_.size());
  for (const int v : which_) {
    const auto i = static_cast<std::size_t>(v);
    if (all_[i].count == 0) continue;
    KeyedRandom random(problem_.seed, i + (key << 32), kStartStage);
    for (int s = 0; s < 4; ++s) {
      Eigen::Matrix3d r;
      if (problem_.planar()) {
        r = so3_exp({0, 0, kTwoPi * random.uniform()});
      } else {
        do r = random.rotation();
        while (!prior_.allows(r));
      }
      state.sample[i].push_back({r.cast<float>(), Eigen::Vector3f::Zero()});
    }
    state.best[i] = state.sample[i].front();
  }
  return state;
}

SoftState SoftAnnealer::from_poses(const std::vector<SoftPose>& pose, const std::vector<int>& posed,
                                   double width) const {
  SoftState state(frame_);
  state.outlier_fraction = options_.first_outlier_fraction;
  state.sample.resize(problem_.size());
  state.best = pose;
  for (const int v : posed) {
    const auto i = static_cast<std::size_t>(v);
    if (all_[i].count > 0) state.sample[i] = {pose[i]};
  }
  fuse(width, state);
  return state;
}

VoxelCounts SoftAnnealer::counts_of(const Points& points, const std::vector<int>& which,
                                    const SoftState& state) const {
  constexpr std::uint32_t kWhole = 48;  // weight of a view: divisible by the usual numbers of samples
  std::vector<Eigen::Matrix3f> images = {Eigen::Matrix3f::Identity()};
  for (std::size_t g = 1; g < state.group.size(); ++g) images.push_back(state.group[g].cast<float>());
  return ordered_sum(which.size(), kDepositViews, VoxelCounts(frame_), [&](std::size_t b, std::size_t e) {
    VoxelCounts some(frame_);
    for (std::size_t v = b; v < e; ++v) {
      const auto i = static_cast<std::size_t>(which[v]);
      const auto& samples = state.sample[i];
      if (samples.empty()) continue;
      const std::uint32_t weight = std::max(1u, kWhole / static_cast<std::uint32_t>(samples.size()));
      // Under a group fewer samples say as much: each comes with its images.
      const std::size_t step = std::clamp<std::size_t>(images.size() / 4, 1, samples.size());
      for (std::size_t k = 0; k < samples.size(); k += step)
        for (const Eigen::Matrix3f& g : images)
          some.add(points[i], g * samples[k].rotation, g * samples[k].translation, weight);
    }
    return some;
  });
}

void SoftAnnealer::draw_density(const VoxelCounts& counts, double width, SoftState& state) const {
  DensityGrid density(counts);
  density.blur(width);
  density.normalise();
  // Expected outliers under the template just made; a prior keeps the share away from 0 and 1.
  double outliers = 0, total = 0;
  const double e = state.outlier_fraction, background = e * outlier_density(problem_.planar());
  for (std::size_t v = 0; v < counts.count().size(); ++v) {
    const auto n = static_cast<double>(counts.count()[v]);
    if (n == 0) continue;
    outliers += n * background / ((1 - e) * static_cast<double>(density.value()[v]) + background);
    total += n;
  }
  const double prior = options_.outlier_pseudo_share;
  if (total > 0)
    state.outlier_fraction =
        std::clamp((outliers / total + options_.first_outlier_fraction * prior) / (1 + prior), 0.01, 0.5);
  state.density = std::move(density);
  state.width = width;
}

struct SoftAnnealer::Looked {
  const LookupPoints& few;  // localisations
  const LogVolume& volume;
  const std::vector<SoftPose>& last;  // samples of the last sweep
  Eigen::Vector3f centre;
  double beta, prior_weight, shift;  // standard deviation of the prior of shifts
  const Scorer& score;               // of the few
};

std::vector<SoftAnnealer::Draw> SoftAnnealer::candidates(const Looked& view, const Grid& grid,
                                                         KeyedRandom& random) const {
  const bool planar = problem_.planar();
  const double beta = view.beta;
  const Eigen::Vector3f& centre = view.centre;
  const Scorer& score = view.score;
  // Enough to leave most rotations out.
  const LookupPoints fewer = first_of(view.few, std::max(std::min(view.few.count, 24), view.few.count / 2));
  const Scorer coarse(view.volume, fewer, prior_, centre, view.shift,
                      view.prior_weight * fewer.count / std::max(1, view.few.count));
  const std::size_t n = grid.rotation.size();
  std::vector<float> rough(n);
  for (std::size_t r = 0; r < n; ++r) coarse(grid.rotation[r], &centre, 1, &rough[r]);
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  const std::size_t promising = std::min(
      n,
      std::max<std::size_t>(24, static_cast<std::size_t>(options_.promising_share * static_cast<double>(n))));
  const auto better = [&](std::uint32_t a, std::uint32_t b) {
    return rough[a] != rough[b] ? rough[a] > rough[b] : a < b;
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(promising) - 1, order.end(),
                   better);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(promising));
  std::vector<Draw> found(promising);
  for (std::size_t k = 0; k < promising; ++k) {
    found[k].pose = {grid.rotation[order[k]], centre};
    found[k].score = score(found[k].pose);
  }
  const auto first = static_cast<float>(view.shift), step = static_cast<float>(options_.shift);
  std::size_t moved = promising;
  for (float ring = first; ring > 0.4f * step; ring *= 0.5f, moved = (moved + 1) / 2) {
    if (moved < promising) {  // those that gained little so far are no longer worth a step
      std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(moved) - 1, found.end(),
                       Draw::better);
    }
    for (std::size_t k = 0; k < moved; ++k) {
      Draw& d = found[k];
      const Eigen::Vector3f from = d.pose.translation;
      Eigen::Vector3f there[6];
      float at[6];
      int m = 0;
      for (int a = 0; a < (planar ? 2 : 3); ++a)
        for (const float sign : {-1.0f, 1.0f}) there[m++] = from + sign * ring * Eigen::Vector3f::Unit(a);
      score(d.pose.rotation, there, static_cast<std::size_t>(m), at);
      for (int s = 0; s < m; ++s)
        if (at[s] > d.score) d.score = at[s], d.pose.translation = there[s];
    }
  }
  if (beta >= options_.climbing_beta) {
    std::stable_sort(found.begin(), found.end(), Draw::better);
    std::vector<Draw> peaks;
    for (std::size_t k = 0;
         k < std::min<std::size_t>(found.size(), static_cast<std::size_t>(options_.climbed)); ++k) {
      if (k > 3 && beta * static_cast<double>(found[k].score - found[0].score) < -14)
        break;  // e^-14: never drawn
      Draw d = found[k];
      d.score = climb(score, centre, static_cast<float>(0.7 * grid.spacing), 0.6f * step, 2, planar, d.pose);
      peaks.push_back(d);
    }
    for (int k = 0; k < options_.kept && !view.last.empty(); ++k)
      peaks.push_back(climbed_again(view, grid.spacing, view.last[random.below(view.last.size())]));
    found = one_of_every_mode(std::move(peaks));
  }
  return found;
}

// The modes of the last sweep, wherever they have moved to.
std::vector<SoftAnnealer::Draw> SoftAnnealer::followed(const Looked& view, double spacing) const {
  std::vector<Draw> found;
  for (const SoftPose& p : view.last) found.push_back({p, view.score(p), 0});
  found = one_of_every_mode(std::move(found));
  for (Draw& d : found) d = climbed_again(view, spacing, d.pose);
  return one_of_every_mode(std::move(found));
}

SoftAnnealer::Draw SoftAnnealer::climbed_again(const Looked& view, double spacing,
                                               const SoftPose& from) const {
  Draw d{from, 0, 0};
  d.score = climb(view.score, view.centre, static_cast<float>(0.3 * spacing),
                  0.4f * static_cast<float>(options_.shift), 1, problem_.planar(), d.pose);
  return d;
}

std::vector<SoftAnnealer::Draw> SoftAnnealer::one_of_every_mode(std::vector<Draw> peaks) const {
  std::stable_sort(peaks.begin(), peaks.end(), Draw::better);
  std::vector<Draw> found;
  const auto near = static_cast<float>(options_.same_mode_deg * kRadiansPerDegree);
  const auto step = static_cast<float>(options_.shift);
  for (const Draw& d : peaks)
    if (std::none_of(found.begin(), found.end(), [&](const Draw& o) {
          return angle_between(o.pose.rotation, d.pose.rotation) < near &&
                 (o.pose.translation - d.pose.translation).norm() < 0.8f * step;
        }))
      found.push_back(d);
  return found;
}

void SoftAnnealer::weigh(double beta, std::vector<Draw>& found) {
  float top = -INFINITY;
  for (const Draw& d : found) top = std::max(top, d.score);
  for (Draw& d : found) d.weight = std::exp(beta * static_cast<double>(d.score - top));
}

// Turned in every sweep. One that follows modes needs the spacing only.
SoftAnnealer::Grid SoftAnnealer::grid_of(const Sweep& sweep, const RotationGroup& group) const {
  KeyedRandom turns(problem_.seed, sweep.key, kGridStage);
  const std::size_t order = std::max<std::size_t>(1, group.size());
  Grid grid;
  if (problem_.planar()) {
    const double first = turns.uniform();
    grid.spacing = kTwoPi / options_.planar_rotations;
    const int n = sweep.follows ? 0 : options_.planar_rotations / static_cast<int>(order);
    for (int i = 0; i < n; ++i)
      grid.rotation.push_back(so3_exp({0, 0, grid.spacing * (i + first)}).cast<float>());
    return grid;
  }
  // Some of the rotations that a prior or a group leaves out are spent on the others.
  const int whole =
      std::min(options_.most_rotations,
               static_cast<int>(sweep.rotations * std::max(1.0, options_.prior_share / prior_.share()) *
                                std::max(1.0, static_cast<double>(order) * options_.unit_share)));
  grid.spacing = 0.5 * std::cbrt(8 * kPi * kPi / whole);
  if (sweep.follows) return grid;
  const Eigen::Matrix3f turn = turns.rotation().cast<float>();
  for (const Eigen::Quaternionf& q : super_fibonacci(whole)) {
    const Eigen::Matrix3f r = q.toRotationMatrix() * turn;
    if (prior_.allows(r) && in_asymmetric_unit(group, r)) grid.rotation.push_back(r);
  }
  if (grid.rotation.empty())  // of a narrow prior and a large group
    grid.rotation.push_back(Eigen::Matrix3f::Identity());
  return grid;
}

void SoftAnnealer::draw_poses(const Points& points, const std::vector<int>& which, const Sweep& sweep,
                              SoftState& state) const {
  const bool planar = problem_.planar();
  const Grid grid = grid_of(sweep, state.group);
  const LogVolume volume(state.density, state.outlier_fraction, outlier_density(planar));
  Eigen::Vector3f centre = state.density.centroid().cast<float>();
  if (!state.group.empty()) {  // on every axis of the group
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const Eigen::Matrix3d& g : state.group) mean += g;
    centre = (mean / static_cast<double>(state.group.size())).cast<float>() * centre;
  }
  if (planar) centre.z() = 0;
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    const LookupPoints& all = points[i];
    if (all.count == 0) return;
    KeyedRandom random(problem_.seed, i + (sweep.key << 32), kPoseStage);
    const LookupPoints few = some_of(all, static_cast<std::size_t>(sweep.localisations), random);
    const double b = sweep.beta * all.count / few.count;  // the few stand for all
    const double warm = std::max(b, 0.02), prior_weight = 1 / warm;
    const Scorer score(volume, few, prior_, centre, shift_[i], prior_weight);
    const Looked view{few, volume, state.sample[i], centre, b, prior_weight, shift_[i], score};
    std::vector<Draw> found = sweep.follows ? followed(view, grid.spacing) : candidates(view, grid, random);
    weigh(b, found);
    double total = 0;
    const Draw* likeliest = &found.front();
    for (const Draw& d : found) {
      total += d.weight;
      if (d.score > likeliest->score) likeliest = &d;
    }
    const double turn = std::min(grid.spacing, options_.jitter_turn / std::sqrt(warm));
    const double shift = std::min(0.08, options_.jitter_shift / std::sqrt(warm));
    const int samples = options_.samples;
    std::vector<SoftPose> drawn;
    double sum = 0;
    const double offset = random.uniform();
    for (const Draw& d : found) {  // systematic: as even as the weights allow
      sum += d.weight / total * samples;
      while (static_cast<int>(drawn.size()) < samples && sum > static_cast<double>(drawn.size()) + offset) {
        SoftPose p = d.pose;
        float at = d.score;
        for (int s = 0; s < options_.jitters; ++s) {
          const double scale = s % 2 == 1 ? 1.0 : 0.4;
          Eigen::Vector3f w = normal3(random, scale * turn, false);
          if (planar) w.x() = w.y() = 0;
          SoftPose q = turned_about(p, centre, small_turn(w));
          q.translation += normal3(random, scale * shift, planar);
          const float there = score(q);
          if (b * static_cast<double>(there - at) > std::log(1 - random.uniform())) p = q, at = there;
        }
        drawn.push_back(p);
      }
    }
    if (drawn.empty()) drawn.push_back(likeliest->pose);
    state.best[i] = likeliest->pose;
    state.sample[i] = std::move(drawn);
  });
}

void SoftAnnealer::anneal(const AnnealStage& stage, std::uint64_t key, SoftState& state) const {
  fuse(stage.first_width, state);
  continue_under(stage, key, state);
}

void SoftAnnealer::continue_under(const AnnealStage& stage, std::uint64_t key, SoftState& state) const {
  for (int t = 0; t < stage.sweeps; ++t) {
    const double f = stage.sweeps > 1 ? static_cast<double>(t) / (stage.sweeps - 1) : 1.0;
    const double g = std::min(1.0, f / stage.narrowing);
    const bool early = stage.from_nothing && f < 0.5;
    const double beta = geometric(stage.first_beta, stage.last_beta, g);
    draw_poses(all_, which_,
               {beta, early ? options_.rotations / 2 : options_.rotations,
                early ? options_.first_localisations : options_.localisations,
                key * 1024 + static_cast<std::uint64_t>(t), t % 2 == 1 && beta >= options_.climbing_beta},
               state);
    fuse(geometric(stage.first_width, stage.last_width, g), state);
  }
}

Evidence SoftAnnealer::judge(SoftState state, std::uint64_t key, const Problem& drawn) const {
  const Points fitted = points_of(drawn.fitted, options_.most_localisations),
               judging = points_of(drawn.held_out, options_.most_judging);
  const auto folds = static_cast<std::size_t>(options_.folds);
  std::vector<std::vector<int>> members(folds);
  for (std::size_t k = 0; k < which_.size(); ++k) members[k % folds].push_back(which_[k]);
  // A view stays where its own localisations in the template hold it, and what judges brought it there: it is
  // posed and judged under a template of other views.
  std::vector<VoxelCounts> counts;
  const auto under_others = [&](std::size_t f, const SoftState& poses) {
    VoxelCounts others(frame_);
    for (std::size_t g = 0; g < folds; ++g)
      if (g != f) others += counts[g];
    SoftState out = poses;
    draw_density(others, poses.width, out);
    return out;
  };
  const auto count = [&] {
    counts.clear();
    for (const std::vector<int>& m : members) counts.push_back(counts_of(fitted, m, state));
  };
  for (std::uint64_t t = 0; t < 2; ++t) {
    count();
    if (t == 0) state.sample.assign(problem_.size(), {});
    for (std::size_t f = 0; f < folds; ++f) {
      SoftState one = under_others(f, state);
      draw_poses(
          fitted, members[f],
          {options_.last_beta, options_.rotations, options_.localisations, key * 1024 + 512 + t, t == 1},
          one);
      for (const int v : members[f]) {
        const auto i = static_cast<std::size_t>(v);
        state.sample[i] = std::move(one.sample[i]), state.best[i] = one.best[i];
      }
    }
  }
  count();
  Evidence out(which_.size(), NAN);
  for (std::size_t f = 0; f < folds; ++f) {
    const SoftState one = under_others(f, state);
    const LogVolume volume(one.density, one.outlier_fraction, outlier_density(problem_.planar()));
    parallel_for(members[f].size(), [&](std::size_t m) {
      const auto i = static_cast<std::size_t>(members[f][m]);
      const LookupPoints& points = judging[i];
      if (points.count == 0 || state.sample[i].empty()) return;
      std::vector<double> score;
      for (const SoftPose& p : state.sample[i])
        score.push_back(static_cast<double>(volume.score(points, p.rotation, p.translation)));
      const double top = *std::max_element(score.begin(), score.end());
      double sum = 0;
      for (const double s : score) sum += std::exp(s - top);
      out[m * folds + f] = (top + std::log(sum / static_cast<double>(score.size()))) / points.count;
    });
  }
  return out;
}

}  // namespace polar
