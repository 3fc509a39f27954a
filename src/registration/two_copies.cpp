#include "two_copies.hpp"

#include <Eigen/Eigenvalues>

#include "jury.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/occupancy.hpp"
#include "polar/fusion/pair_search.hpp"
#include "symmetry_frame.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::size_t kLocalisations = 200;  // of a view
constexpr double kStrength = 1;              // of the occupancy's prior
constexpr double kTwoGroups =
    1.5;  // kurtosis: 1 for two equal groups, 1.8 for an even spread, 3 for a normal one
constexpr int kIterations = 60;
constexpr std::uint32_t kVectorStage = 37;
constexpr std::size_t kFewAsked = 16, kAsked = 50;  // views: the few say no, where there is nothing
constexpr double kLooksAlike = 0.5;  // similarity of a template after a half turn that may be confused
constexpr double kClear = 0.7;       // share of what pairs say that must come out: 0.3 to 0.6 of noise

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

// How well pairs of views agree where both looked, the second turned in the template.
struct Agreement {
  Eigen::MatrixXd seen, fit;
};
Agreement agreement_of_pairs(const PairSearch& pairs, const std::vector<Pose>& pose, const Pose& turn) {
  const auto n = static_cast<Eigen::Index>(pose.size());
  Agreement out{Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Zero(n, n)};
  parallel_for(pose.size(), [&](std::size_t a) {
    for (std::size_t b = a + 1; b < pose.size(); ++b) {
      const Match match = pairs.refined(a, b, pose[a].inverse() * turn * pose[b]);
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      out.seen(i, j) = out.seen(j, i) = match.seen;
      out.fit(i, j) = out.fit(j, i) = match.fit;
    }
  });
  return out;
}

// Views into two groups (+-1, the larger +1) so that what pairs say for being in the same one, or against it,
// comes out: signs of the leading eigenvector (synchronisation over Z2, A. Singer, Applied and Computational
// Harmonic Analysis 30, 2011).
Eigen::VectorXd two_groups(const Eigen::MatrixXd& for_the_same) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(for_the_same);
  const Eigen::VectorXd leading = solver.eigenvectors().rightCols<1>();
  const Eigen::VectorXd group = (leading.array() > 0).select(Eigen::VectorXd::Ones(leading.size()), -1.0);
  return group.sum() < 0 ? Eigen::VectorXd(-group) : group;
}

// Poses with some views turned by the one of `turns` for which pairs say so most clearly; none where they do
// not.
std::vector<Pose> as_pairs_say(const Problem& problem, const std::vector<int>& which,
                               const std::vector<Pose>& pose, const std::vector<Pose>& turns) {
  const PairSearch pairs(problem.views, problem.axes, problem.fitted, which);
  const Agreement as_it_is =
      agreement_of_pairs(pairs, pose, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()});
  double most = kClear;
  std::vector<Pose> better;
  for (const Pose& turn : turns) {
    const Agreement turned = agreement_of_pairs(pairs, pose, turn);
    // Weighed by what both alignments show: parts that overlap more after a turn are not the likelier for it.
    const Eigen::MatrixXd same = as_it_is.seen.cwiseMin(turned.seen).cwiseProduct(as_it_is.fit - turned.fit);
    const Eigen::VectorXd group = two_groups(same);
    const double gain = (group.dot(same * group) - same.sum()) / same.cwiseAbs().sum();
    if (!(gain > most)) continue;
    most = gain;
    better = pose;
    for (std::size_t k = 0; k < pose.size(); ++k)
      if (group[static_cast<Eigen::Index>(k)] < 0) better[k] = turn * pose[k];
  }
  return better;
}

// The larger of two groups of parts that agree among themselves better than with each other, as they are
// posed.
std::vector<int> parts_of_one_copy(const Problem& problem, const RoundState& state) {
  const std::vector<int> which = some_views(problem, kAsked);
  const PairSearch pairs(problem.views, problem.axes, problem.fitted, which);
  const Pose as_it_is;
  Eigen::MatrixXd fit = agreement_of_pairs(pairs, poses_of(state, which), as_it_is).fit;
  const auto n = static_cast<double>(fit.rows());
  fit.diagonal().setConstant(fit.sum() / std::max(1.0, n * (n - 1)));
  const Eigen::VectorXd of_view = fit.rowwise().mean();
  fit = (fit.colwise() - of_view).rowwise() - of_view.transpose();
  fit.array() += of_view.mean();
  const Eigen::VectorXd group = two_groups(fit);
  std::vector<int> out;
  for (std::size_t k = 0; k < which.size(); ++k)
    if (group[static_cast<Eigen::Index>(k)] > 0) out.push_back(which[k]);
  return out;
}

}  // namespace

std::vector<int> views_of_one_copy(const Problem& problem, const RoundState& state) {
  if (state.cut) return parts_of_one_copy(problem, state);
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

std::vector<int> turn_back(const Problem& problem, RoundState& state) {
  const std::vector<Pose> turns = half_turns(SelfSimilarity(state.mixture, problem.planar()), kLooksAlike);
  if (turns.empty()) return {};
  const auto ask = [&](const std::vector<int>& which) {
    return as_pairs_say(problem, which, poses_of(state, which), turns);
  };
  if (ask(some_views(problem, kFewAsked)).empty()) return {};
  std::vector<int> which = some_views(problem, kAsked);
  const std::vector<Pose> better = ask(which);
  if (better.empty()) return {};
  for (std::size_t k = 0; k < which.size(); ++k) state.pose[static_cast<std::size_t>(which[k])] = better[k];
  return which;
}

}  // namespace polar
