#include "sides.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "jury.hpp"
#include "symmetry_frame.hpp"
#include "template_tools.hpp"

namespace polar {

namespace {

constexpr std::size_t kFewestOfAView = 150;  // localisations: the centre of fewer moves by chance
constexpr double kLeastSpread =
    0.07;  // particle radii: standard deviation of the views' centres; 0.02 of whole views
constexpr double kLooksAlike = 0.5;  // similarity of a template after a half turn that may be confused
constexpr double kCuts[] = {1.0 / 6, 1.0 / 3, 1.0 / 2, 2.0 / 3, 5.0 / 6};  // shares of the views on one side
constexpr std::size_t kAsked = 64;                                         // views
constexpr std::size_t kLocalisations = 200;                                // of each
constexpr double kWidths[] = {0.09, 0.065, 0.045, 0.03};                   // of the template, in turn
constexpr int kSweeps = 3;                                                 // at each
constexpr double kGain =
    0.002;  // of held-out log likelihood; of a side that lies right a turn loses 0.03 and more

// The direction in which the centres of the views differ most, and where along it each lies.
struct MainAxis {
  Eigen::Vector3d direction;
  std::vector<double> along;
};
MainAxis main_axis(const Problem& problem, const std::vector<Pose>& pose) {
  Eigen::Matrix3Xd centre(3, static_cast<Eigen::Index>(problem.size()));
  for (std::size_t i = 0; i < problem.size(); ++i) {
    const Eigen::Matrix3Xf& points = problem.views.view[i].points;
    const auto count = static_cast<double>(std::max<Eigen::Index>(1, points.cols()));
    centre.col(static_cast<Eigen::Index>(i)) =
        pose[i] * (points.rowwise().sum().cast<double>() / count).eval();
  }
  centre.colwise() -= centre.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centre * centre.transpose());
  const Eigen::Vector3d direction = solver.eigenvectors().col(2);
  const Eigen::VectorXd along = centre.transpose() * direction;
  return {direction, {along.begin(), along.end()}};
}

double standard_deviation(const std::vector<double>& about_zero) {
  double squares = 0;
  for (const double x : about_zero) squares += x * x;
  return std::sqrt(squares / static_cast<double>(about_zero.size()));
}

// What lies below the first `share` of the sorted values.
double cut_at(double share, std::vector<double> values) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

// The poses of all views, with those below the cut turned.
std::vector<Pose> turned_below(double cut, const std::vector<double>& along, const Pose& turn,
                               std::vector<Pose> pose) {
  for (std::size_t i = 0; i < pose.size(); ++i)
    if (along[i] < cut) pose[i] = turn * pose[i];
  return pose;
}

// How well a template that is fitted from scratch to views at these poses explains what is held out of them.
double explained(const Problem& problem, const RoundState& state, const std::vector<int>& which) {
  std::vector<Pose> pose = poses_of(state, which);
  const Subsets few = first_of(problem.fitted, kLocalisations);
  Mixture mixture = scattered_mixture(problem, few, which, pose, centres_for(problem), 1);
  mixture.outlier_fraction = first_outlier_fraction(state.crowded);
  NoiseModel noise;
  noise.planar = problem.planar();
  for (const double width : kWidths) {
    noise.width = width;
    const FusionData data(problem.views, problem.axes, noise, few, which);
    MaximisationOptions em = fusion_options(state.crowded, width);
    em.seed = problem.seed;
    for (int s = 0; s < kSweeps; ++s) {
      maximise(mixture, data, pose, em);
      if (s > 0) refine_poses(mixture, data, pose, 2);
    }
  }
  return held_out_score(problem, problem.held_out, which, mixture, pose, noise.width);
}

}  // namespace

std::vector<int> turn_side(const Problem& problem, RoundState& state) {
  if (problem.planar()) return {};  // half turns in the plane lay one side over the other
  const std::vector<int> which = some_views(problem, kAsked);
  if (median_size(problem.fitted, which) < kFewestOfAView) return {};
  const auto [direction, along] = main_axis(problem, state.pose);
  if (standard_deviation(along) < kLeastSpread) return {};
  double most = explained(problem, state, which) + kGain;
  std::vector<Pose> better;
  RoundState other = state;
  for (const Pose& turn : half_turns(SelfSimilarity(state.mixture, problem.planar()), kLooksAlike)) {
    // Half of a structure with two equal ends explains all its crops, laid over each other, better than the
    // whole.
    if (direction.dot(turn.rotation * direction) < 0) continue;
    for (const double share : kCuts) {
      other.pose = turned_below(cut_at(share, along), along, turn, state.pose);
      const double score = explained(problem, other, which);
      if (score > most) most = score, better = other.pose;
    }
  }
  if (better.empty()) return {};
  state.pose = std::move(better);
  return problem.all;
}

}  // namespace polar
