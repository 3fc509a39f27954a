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

}  // namespace polar
