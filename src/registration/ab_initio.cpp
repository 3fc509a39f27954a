#include "ab_initio.hpp"

#include <algorithm>
#include <cmath>

#include "fullness.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/maximisation.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kFirstPoseStage = 21, kTurnStage = 23, kDrawStage = 24;
constexpr int kSigmaClasses = 2;  // a wide template hardly tells uncertainties apart
constexpr int kPlanarRotations = 90;
constexpr std::size_t kFullestOneOf = 4, kFewestFullest = 32;
constexpr std::size_t kMostViews = 64, kMostLocalisations = 96, kMostHeldOut = 64;

double interpolate(double first, double last, double t) { return first * std::pow(last / first, t); }

Eigen::Matrix3d random_rotation(KeyedRandom& random, bool planar) {
  if (!planar) return random.rotation();
  return Eigen::AngleAxisd(2 * kPi * random.uniform(), Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// Index drawn with probability proportional to exp(beta * score).
std::size_t draw(const std::vector<float>& score, double beta, double u) {
  const auto top = std::max_element(score.begin(), score.end());
  double total = 0;
  for (const float s : score) total += std::exp(beta * static_cast<double>(s - *top));
  double left = u * total;
  for (std::size_t i = 0; i < score.size(); ++i) {
    left -= std::exp(beta * static_cast<double>(score[i] - *top));
    if (left <= 0) return i;
  }
  return static_cast<std::size_t>(top - score.begin());
}

void draw_poses(const StartContext& context, const NoiseModel& noise, const SearchGrid& grid,
                const Eigen::Matrix3f& turn, const SearchOptions& search, double beta, std::uint32_t stage,
                Hypothesis& h) {
  const Problem& p = context.problem;
  const SigmaClasses classes = sigma_classes(p.views, p.axes, noise, kSigmaClasses);
  const DirectionVolumes volumes(h.mixture, classes, directions_for(classes, p.planar()), p.planar());
  parallel_for(context.which.size(), [&](std::size_t v) {
    const auto i = static_cast<std::size_t>(context.which[v]);
    if (context.fitted[i].empty()) return;
    const SearchView view = search_view(p.views.view[i], p.axes[i], noise, classes, context.fitted[i]);
    const GridScores scores = score_grid(volumes, view, grid, turn, search);
    KeyedRandom random(p.seed, i, stage);
    const std::size_t at = draw(scores.log_likelihood, beta, random.uniform());
    h.pose[v] = {(grid.rotation[at] * turn).cast<double>(), scores.translation[at].cast<double>()};
  });
}

}  // namespace

StartContext start_context(const Problem& problem) {
  return {problem, some_views(problem, kMostViews), first_of(problem.fitted, kMostLocalisations),
          first_of(problem.held_out, kMostHeldOut)};
}

StartContext fullest_context(const Problem& problem) {
  StartContext context = start_context(problem);
  context.which = fullest_views(problem, context.fitted,
                                std::clamp(problem.size() / kFullestOneOf, kFewestFullest, kMostViews));
  return context;
}

Hypothesis with_template(const StartContext& context, int centres, Hypothesis h) {
  h.mixture = scattered_mixture(context.problem, context.fitted, context.which, h.pose, centres,
                                static_cast<std::uint64_t>(h.number));
  h.mixture.outlier_fraction = first_outlier_fraction(h.crowded);
  return h;
}

Hypothesis random_start(const StartContext& context, int centres, int number, bool crowded) {
  Hypothesis h;
  h.name = "random " + std::to_string(number);
  h.crowded = crowded;
  h.number = number;
  h.pose.resize(context.which.size());
  KeyedRandom random(context.problem.seed, static_cast<std::uint64_t>(number), kFirstPoseStage);
  for (Pose& pose : h.pose) pose.rotation = random_rotation(random, context.problem.planar());
  return with_template(context, centres, std::move(h));
}

Hypothesis imaged_start(const StartContext& context, int centres, int number) {
  Hypothesis h;
  h.name = "imaged";
  h.number = number;
  h.pose.resize(context.which.size());
  return with_template(context, centres, std::move(h));
}

Hypothesis one_view_start(const StartContext& context, int centres, int number, int rank) {
  Hypothesis h;
  h.name = "one view " + std::to_string(rank);
  h.number = number;
  h.one_view = true;
  h.pose.resize(context.which.size());
  const int view = context.which[static_cast<std::size_t>(rank) % context.which.size()];
  h.mixture = scattered_mixture(context.problem, context.fitted, {view}, {Pose()}, centres,
                                static_cast<std::uint64_t>(number));
  h.mixture.outlier_fraction = first_outlier_fraction(h.crowded);
  return h;
}

void anneal(const StartContext& context, const AnnealingOptions& options, bool keep_first_poses,
            Hypothesis& h) {
  const Problem& p = context.problem;
  const auto key = static_cast<std::uint64_t>(h.number);
  const SearchGrid grid = search_grid(p.planar() ? kPlanarRotations : options.rotations, p.planar());
  KeyedRandom turns(p.seed, key, kTurnStage);
  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const double t = options.sweeps > 1 ? static_cast<double>(sweep) / (options.sweeps - 1) : 1.0;
    NoiseModel noise;
    noise.planar = p.planar();
    noise.width = interpolate(options.first_width, options.last_width, t);
    const FusionData data(p.views, p.axes, noise, context.fitted, context.which);
    if (sweep > 0 || !keep_first_poses) {
      SearchOptions search;
      search.translation =
          shifts_within(options.reach, options.shift * static_cast<float>(1.0 - 0.5 * t), p.planar());
      const Eigen::Matrix3f turn = random_rotation(turns, p.planar()).cast<float>();
      draw_poses(context, noise, grid, turn, search, interpolate(options.first_beta, options.last_beta, t),
                 kDrawStage + 16 * static_cast<std::uint32_t>(sweep + 1000 * h.number), h);
      refine_poses(h.mixture, data, h.pose, 3);
    }
    MaximisationOptions em = fusion_options(h.crowded, noise.width);
    em.seed = p.seed + key * 1000 + static_cast<std::uint64_t>(sweep);
    for (int step = 0; step < options.maximisations; ++step) maximise(h.mixture, data, h.pose, em);
  }
  h.held_out = held_out_score(p, context.held_out, context.which, h.mixture, h.pose, options.last_width);
}

}  // namespace polar
