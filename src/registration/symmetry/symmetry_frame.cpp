#include "symmetry_frame.hpp"

#include <algorithm>
#include <cmath>

#include "polar/core/constants.hpp"
#include "polar/core/nelder_mead.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/so3.hpp"
#include "polar/core/spiral.hpp"
#include "polar/core/symmetry_group.hpp"

namespace polar {

namespace {

constexpr std::size_t kDirections = 4000;  // of axes, 2.3 degrees apart; a search's width is 3.4 at the rim
constexpr double kAxesApart = 0.35;        // rad, of axes that are tried for one group
constexpr std::size_t kAxesTried = 3;
constexpr double kSweepStep = 1.5 * kRadiansPerDegree;  // of the turn about a main axis
constexpr std::size_t kMostTurns = 16;                  // of a group that a frame is refined by
constexpr double kRefineStep = 0.03;                    // rad and particle radii: the search's resolution
constexpr int kRefineEvaluations = 240;
constexpr double kRefineTolerance = 1e-4;

using Axis = Eigen::Vector3d;

// The axis of highest order, in the group's own frame (core/symmetry_group.hpp).
struct MainAxis {
  Axis axis;
  int fold;
};
MainAxis main_axis(const std::string& group) {
  if (group == "T") return {Axis(1, 1, 1).normalized(), 3};
  if (group == "O") return {Axis::UnitZ(), 4};
  if (group == "I") return {Axis(0, 1, (1 + std::sqrt(5.0)) / 2).normalized(), 5};
  return {Axis::UnitZ(), std::stoi(group.substr(1))};
}

Axis direction(std::size_t i) {
  return spiral_direction<double>(static_cast<int>(i), static_cast<int>(kDirections), Spiral::hemisphere);
}

// The best axes of this order, best first, well apart.
std::vector<Axis> best_axes(const SelfSimilarity& t, int fold) {
  if (t.planar()) return {Axis::UnitZ()};
  std::vector<std::pair<double, std::size_t>> score(kDirections);
  const Eigen::Vector3d centre = t.centroid();
  parallel_for(kDirections, [&](std::size_t i) {
    score[i] = {-t.coarse(so3_exp(kTwoPi / fold * direction(i)), centre), i};
  });
  std::sort(score.begin(), score.end());
  std::vector<Axis> best;
  for (const auto& [cost, i] : score) {
    const Axis a = direction(i);
    const bool near = std::any_of(best.begin(), best.end(),
                                  [&](const Axis& b) { return std::abs(a.dot(b)) > std::cos(kAxesApart); });
    if (!near) best.push_back(a);
    if (best.size() == kAxesTried) break;
  }
  return best;
}

// The group's turns but the identity, evenly thinned where they are many.
std::vector<Eigen::Matrix3d> some_turns(const std::string& group, std::size_t most) {
  const std::vector<Eigen::Matrix3d> all = symmetry_rotations(group);
  const std::size_t n = all.size() - 1, kept = std::min(n, most);
  std::vector<Eigen::Matrix3d> some;
  for (std::size_t i = 0; i < kept; ++i) some.push_back(all[1 + i * n / kept]);
  return some;
}

// Motions of the template by the group's turns, its frame at `rotation` and `centre`.
std::vector<Pose> motions(const std::vector<Eigen::Matrix3d>& turns, const Eigen::Matrix3d& rotation,
                          const Eigen::Vector3d& centre) {
  std::vector<Pose> out;
  for (const Eigen::Matrix3d& g : turns) {
    const Eigen::Matrix3d turn = rotation.transpose() * g * rotation;
    out.push_back({turn, centre - turn * centre});
  }
  return out;
}

// The frame with the main axis along `axis` and the best turn about it.
Eigen::Matrix3d swept(const SelfSimilarity& t, const std::string& group, const Axis& axis) {
  const MainAxis main = main_axis(group);
  Eigen::Matrix3d first = Eigen::Quaterniond::FromTwoVectors(axis, main.axis).toRotationMatrix();
  if (group[0] == 'C') return first;
  const std::vector<Eigen::Matrix3d> turns = some_turns(group, kMostTurns);
  const auto steps = static_cast<std::size_t>(std::ceil(kTwoPi / main.fold / kSweepStep));
  std::vector<double> score(steps);
  const auto frame = [&](std::size_t s) -> Eigen::Matrix3d {
    return so3_exp(kTwoPi / main.fold * static_cast<double>(s) / static_cast<double>(steps) * main.axis) *
           first;
  };
  parallel_for(steps, [&](std::size_t s) {
    const Eigen::Matrix3d f = frame(s);
    for (const Eigen::Matrix3d& g : turns) score[s] += t.coarse(f.transpose() * g * f, t.centroid());
  });
  return frame(static_cast<std::size_t>(std::max_element(score.begin(), score.end()) - score.begin()));
}

double coarse_similarity(const SelfSimilarity& t, const std::string& group, const Eigen::Matrix3d& frame) {
  const std::vector<Eigen::Matrix3d> turns = some_turns(group, kMostTurns);
  double sum = 0;
  for (const Eigen::Matrix3d& g : turns) sum += t.coarse(frame.transpose() * g * frame, t.centroid());
  return sum / static_cast<double>(turns.size());
}

SymmetryFrame refined(const SelfSimilarity& t, const std::string& group, const Eigen::Matrix3d& frame) {
  const std::vector<Eigen::Matrix3d> turns = some_turns(group, kMostTurns);
  const auto rotation = [&](const std::vector<double>& p) -> Eigen::Matrix3d {
    return t.planar() ? frame : Eigen::Matrix3d(so3_exp({p[2], p[3], p[4]}) * frame);
  };
  const auto centre = [&](const std::vector<double>& p) -> Eigen::Vector3d {
    return t.centroid() + Eigen::Vector3d(p[0], p[1], t.planar() ? 0 : p[5]);
  };
  const std::vector<double> best = nelder_mead(
      std::vector<double>(t.planar() ? 2 : 6, 0.0), {kRefineStep, kRefineTolerance, kRefineEvaluations},
      [&](const std::vector<double>& p) { return -t.exact(motions(turns, rotation(p), centre(p))); });
  const Eigen::Matrix3d r = rotation(best);
  return {group, {r, -(r * centre(best))}, t.exact(motions(turns, r, centre(best)))};
}

}  // namespace

SymmetryFrame best_frame(const SelfSimilarity& t, const std::string& group, double worthwhile) {
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double most = -INFINITY;
  for (const Axis& axis : best_axes(t, main_axis(group).fold)) {
    const Eigen::Matrix3d frame = swept(t, group, axis);
    const double score = coarse_similarity(t, group, frame);
    if (score > most) most = score, best = frame;
  }
  // Unrefined, a frame may miss by half a step: one that is half as good as asked may still become it.
  if (most < 0.5 * worthwhile) return {group, {best, -(best * t.centroid())}, most};
  return refined(t, group, best);
}

}  // namespace polar
