#include "template_tools.hpp"

#include <algorithm>
#include <numeric>

#include "polar/core/constants.hpp"
#include "polar/core/rng.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kFirstCentreStage = 22;
constexpr double kOutlierRadius = 1.5;  // particle radii: the ball (disc) of the uniform class
}  // namespace

std::string too_few_localisations() {
  return "fewer than " + std::to_string(kFewestLocalisations) + " localisations";
}

double outlier_density(bool planar) {
  const double r = kOutlierRadius;
  return planar ? 1 / (kPi * r * r) : 3 / (4 * kPi * r * r * r);
}

double first_outlier_fraction(bool crowded) { return crowded ? 0.4 : 0.05; }

MaximisationOptions fusion_options(bool crowded, double width) {
  MaximisationOptions em;
  em.reseed_distance = 0.5 * width;
  em.weakest_share = crowded ? 0.3 : 0.05;
  return em;
}

Mixture scattered_mixture(const Problem& problem, const Subsets& subsets, const std::vector<int>& which,
                          const std::vector<Pose>& pose, int centres, std::uint64_t key) {
  Mixture m;
  m.centre = Eigen::Matrix3Xf::Zero(3, centres);
  m.weight = Eigen::VectorXf::Constant(centres, 1.0f / static_cast<float>(centres));
  m.outlier_density = outlier_density(problem.planar());
  KeyedRandom random(problem.seed, key, kFirstCentreStage);
  for (int k = 0; k < centres; ++k) {
    const std::size_t v = random.below(which.size());
    const auto i = static_cast<std::size_t>(which[v]);
    if (subsets[i].empty()) continue;
    const auto j = static_cast<Eigen::Index>(subsets[i][random.below(subsets[i].size())]);
    m.centre.col(k) = (pose[v] * problem.views.view[i].points.col(j).cast<double>()).cast<float>();
  }
  sort_into_blocks(m);
  return m;
}

double held_out_score(const Problem& problem, const Subsets& held_out, const std::vector<int>& which,
                      const Mixture& mixture, const std::vector<Pose>& pose, double width) {
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = width;
  const FusionData data(problem.views, problem.axes, noise, held_out, which);
  const std::vector<double> mean = mean_log_likelihood(mixture, data, pose);
  return std::accumulate(mean.begin(), mean.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, mean.size()));
}

double mean_per_localisation(const std::vector<double>& mean_of_view, const std::vector<int>& which,
                             const Subsets& judged) {
  double total = 0, count = 0;
  for (std::size_t k = 0; k < which.size(); ++k) {
    const auto n = static_cast<double>(judged[static_cast<std::size_t>(which[k])].size());
    total += n * mean_of_view[k], count += n;
  }
  return total / std::max(1.0, count);
}

double held_out_score(const Problem& problem, const Mixture& mixture, const std::vector<Pose>& pose,
                      const NoiseModel& noise, bool cut) {
  FusionData data(problem.views, problem.axes, noise, problem.held_out, problem.all);
  if (cut) data.set_cut(problem.reach);
  return mean_per_localisation(mean_log_likelihood(mixture, data, pose), problem.all, problem.held_out);
}

double mean_gain_of_cuts(const Problem& problem, const Mixture& mixture, const std::vector<Pose>& pose) {
  const CutTable cuts(mixture);
  double total = 0;
  for (std::size_t i = 0; i < pose.size(); ++i)
    total += static_cast<double>(CutTable::gain(cuts.likeliest(problem.reach[i], pose[i]).visible, 1));
  return total / static_cast<double>(std::max<std::size_t>(1, pose.size()));
}

}  // namespace polar
