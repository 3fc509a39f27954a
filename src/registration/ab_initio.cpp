#include "ab_initio.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/maximisation.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kFirstPoseStage = 21, kFirstCentreStage = 22, kTurnStage = 23, kDrawStage = 24;
constexpr int kSigmaClasses = 2;  // a wide template hardly tells uncertainties apart
constexpr double kOutlierRadius = 1.5;  // particle radii; the ball of the uniform class

double interpolate(double first, double last, double t) { return first * std::pow(last / first, t); }

NoiseModel noise_of(const StartContext& context, double width) {
  NoiseModel noise;
  noise.width = width;
  noise.planar = context.views.planar;
  return noise;
}

Mixture scattered(const StartContext& context, const std::vector<Pose>& pose, int centres, std::uint64_t number) {
  Mixture m;
  m.centre.resize(3, centres);
  m.weight = Eigen::VectorXf::Constant(centres, 1.0f / static_cast<float>(centres));
  const double r = kOutlierRadius;
  m.outlier_density = context.views.planar ? 1 / (3.14159265 * r * r) : 3 / (4 * 3.14159265 * r * r * r);
  KeyedRandom random(context.seed, number, kFirstCentreStage);
  for (int k = 0; k < centres; ++k) {
    const std::size_t v = random.below(context.which.size());
    const auto i = static_cast<std::size_t>(context.which[v]);
    const auto& from = context.fitted[i];
    if (from.empty()) {
      m.centre.col(k).setZero();
      continue;
    }
    const auto j = static_cast<Eigen::Index>(from[random.below(from.size())]);
    m.centre.col(k) = (pose[v] * context.views.view[i].points.col(j).cast<double>()).cast<float>();
  }
  sort_into_blocks(m);
  return m;
}

// Index drawn with probability proportional to exp(beta * score).
std::size_t draw(const std::vector<float>& score, double beta, double u) {
  const float best = *std::max_element(score.begin(), score.end());
  double total = 0;
  for (const float s : score) total += std::exp(beta * static_cast<double>(s - best));
  double left = u * total;
  for (std::size_t i = 0; i < score.size(); ++i) {
    left -= std::exp(beta * static_cast<double>(score[i] - best));
    if (left <= 0) return i;
  }
  return static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin());
}

}  // namespace

double held_out_score(const StartContext& context, const Mixture& mixture, const std::vector<Pose>& pose, double width) {
  const FusionData data(context.views, context.axes, noise_of(context, width), context.held_out, context.which);
  const std::vector<double> mean = mean_log_likelihood(mixture, data, pose);
  double total = 0;
  for (const double m : mean) total += m;
  return total / static_cast<double>(std::max<std::size_t>(1, mean.size()));
}

Hypothesis anneal(const StartContext& context, const AnnealingOptions& options, FirstPoses first, int number) {
  const bool planar = context.views.planar;
  const auto key = static_cast<std::uint64_t>(number);
  Hypothesis h;
  h.pose.resize(context.which.size());
  KeyedRandom first_poses(context.seed, key, kFirstPoseStage);
  if (first == FirstPoses::random)
    for (Pose& p : h.pose)
      p.rotation = planar ? Eigen::Matrix3d(Eigen::AngleAxisd(6.283185307 * first_poses.uniform(), Eigen::Vector3d::UnitZ()))
                          : first_poses.rotation();
  h.mixture = scattered(context, h.pose, options.centres, key);
  const SearchGrid grid = search_grid(planar ? 90 : options.rotations, planar);
  KeyedRandom turns(context.seed, key, kTurnStage);

  for (int sweep = 0; sweep < options.sweeps; ++sweep) {
    const double t = options.sweeps > 1 ? static_cast<double>(sweep) / (options.sweeps - 1) : 1.0;
    const NoiseModel noise = noise_of(context, interpolate(options.first_width, options.last_width, t));
    const double beta = interpolate(options.first_beta, options.last_beta, t);
    const FusionData data(context.views, context.axes, noise, context.fitted, context.which);
    if (sweep > 0 || first == FirstPoses::random) {
      const SigmaClasses classes = sigma_classes(context.views, context.axes, noise, kSigmaClasses);
      const DirectionVolumes volumes(h.mixture, classes, directions_for(classes, planar), planar);
      SearchOptions search;
      search.translation = axis_shifts(options.shift * static_cast<float>(1.0 - 0.5 * t), planar);
      const Eigen::Matrix3f turn =
          planar ? Eigen::Matrix3f(Eigen::AngleAxisf(static_cast<float>(turns.uniform()), Eigen::Vector3f::UnitZ()))
                 : Eigen::Matrix3f(turns.rotation().cast<float>());
      parallel_for(context.which.size(), [&](std::size_t v) {
        const auto i = static_cast<std::size_t>(context.which[v]);
        if (context.fitted[i].empty()) return;
        const SearchView view = search_view(context.views.view[i], context.axes[i], noise, classes, context.fitted[i]);
        const GridScores scores = score_grid(volumes, view, grid, turn, search);
        KeyedRandom random(context.seed, i, kDrawStage + 16 * static_cast<std::uint32_t>(sweep + 1000 * number));
        const std::size_t at = draw(scores.log_likelihood, beta, random.uniform());
        h.pose[v] = {(grid.rotation[at] * turn).cast<double>(), scores.translation[at].cast<double>()};
      });
      refine_poses(h.mixture, data, h.pose, 3);
    }
    MaximisationOptions em;
    em.seed = context.seed + key * 1000 + static_cast<std::uint64_t>(sweep);
    em.reseed_distance = 0.5 * noise.width;
    for (int step = 0; step < options.maximisations; ++step) maximise(h.mixture, data, h.pose, em);
  }
  h.held_out = held_out_score(context, h.mixture, h.pose, options.last_width);
  return h;
}

}  // namespace polar
