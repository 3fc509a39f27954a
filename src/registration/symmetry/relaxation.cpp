#include "relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kImageStage = 45;

// One image of every pose, drawn with probability exp(beta L) under the present template.
void draw_images(const Problem& problem, const RotationGroup& group, double beta, std::uint64_t key,
                 Fit& fit) {
  const FusionData data(problem.views, problem.axes, fit.noise, problem.fitted);
  std::vector<std::vector<double>> score(group.size());
  std::vector<std::vector<Pose>> image(group.size(), fit.pose);
  for (std::size_t g = 0; g < group.size(); ++g) {
    for (Pose& p : image[g]) p = Pose{group[g], Eigen::Vector3d::Zero()} * p;
    score[g] = mean_log_likelihood(fit.mixture, data, image[g]);
  }
  for (std::size_t i = 0; i < fit.pose.size(); ++i) {
    const double localisations = static_cast<double>(problem.fitted[i].size());
    double top = -INFINITY, total = 0;
    for (const auto& s : score) top = std::max(top, s[i]);
    std::vector<double> weight;
    for (const auto& s : score) {
      weight.push_back(std::exp(beta * localisations * (s[i] - top)));
      total += weight.back();
    }
    double left = total * KeyedRandom(problem.seed, i + (key << 32), kImageStage).uniform();
    std::size_t g = 0;
    while (g + 1 < group.size() && (left -= weight[g]) > 0) ++g;
    fit.pose[i] = image[g][i];
  }
}

}  // namespace

Fit relaxed(const Problem& problem, const Refiner& refiner, const EngineOptions& options,
            const Fit& symmetric) {
  const SymmetryOptions& o = options.symmetry;
  const RotationGroup group = symmetric.group;
  Fit best;
  for (int k = 0; k < o.relabellings; ++k) {
    const auto key = static_cast<std::uint64_t>(1000 * (k + 1));
    Fit fit = symmetric;
    fit.group.clear();
    fit.noise.width = options.refine.first_width;  // as sharp as evidence allows comes after
    draw_images(problem, group, 0, key, fit);
    refiner.sweep_blind(fit, 2);
    for (int t = 0; t < o.relabelling_sweeps; ++t) {
      const double beta =
          t + 1 == o.relabelling_sweeps ? 1 : static_cast<double>(t + 1) / o.relabelling_sweeps;
      draw_images(problem, group, beta, key + static_cast<std::uint64_t>(t) + 1, fit);
      refiner.sweep_blind(fit, 1);
    }
    fit.evidence = refiner.judge(fit);  // images were chosen without what judges
    fit = refiner.narrowed(std::move(fit));
    if (best.pose.empty() || compare(best.evidence, fit.evidence).better_by(0)) best = std::move(fit);
  }
  return best;
}

}  // namespace polar
