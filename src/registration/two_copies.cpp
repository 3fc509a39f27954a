#include "two_copies.hpp"

#include "jury.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/occupancy.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::size_t kLocalisations = 200;  // of a view
constexpr double kStrength = 1;              // of the occupancy's prior
constexpr double kTwoGroups =
    1.5;  // kurtosis: 1 for two equal groups, 1.8 for an even spread, 3 for a normal one
constexpr int kIterations = 60;
constexpr std::uint32_t kVectorStage = 37;

// Where views differ most in the centres they show: the first principal component, one number a view.
Eigen::VectorXf first_component(const Eigen::MatrixXf& shown, std::uint64_t seed) {
  const Eigen::MatrixXf m = shown.rowwise() - shown.colwise().mean();
  Eigen::VectorXf u(m.rows());
  KeyedRandom random(seed, 0, kVectorStage);
  for (float& x : u) x = static_cast<float>(random.normal());
  for (int i = 0; i < kIterations; ++i) {
    u = (m * (m.transpose() * u)).eval();
    const float length = u.norm();
    if (!(length > 0)) return Eigen::VectorXf::Zero(m.rows());
    u /= length;
  }
  return u;
}

}  // namespace

std::vector<int> views_of_one_copy(const Problem& problem, const RoundState& state) {
  NoiseModel noise;
  noise.planar = problem.planar();
  noise.width = state.width;
  const FusionData data(problem.views, problem.axes, noise, first_of(problem.fitted, kLocalisations));
  const auto factor = occupancy(state.mixture, data, state.pose, kStrength, reach_of(noise));
  Eigen::MatrixXf shown =
      state.mixture.weight.transpose().replicate(static_cast<Eigen::Index>(problem.size()), 1);
  for (std::size_t i = 0; i < factor.size(); ++i)  // a view without localisations has none
    for (std::size_t k = 0; k < factor[i].size(); ++k)
      shown(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) *= factor[i][k];
  const Eigen::ArrayXf u = first_component(shown, problem.seed).array();
  const float kurtosis = u.square().square().mean() / (u.square().mean() * u.square().mean());
  if (!(kurtosis < kTwoGroups)) return {};
  const bool positive = 2 * (u > 0).count() >= u.size();
  std::vector<int> out;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if ((u[i] > 0) == positive) out.push_back(static_cast<int>(i));
  return out;
}

}  // namespace polar
