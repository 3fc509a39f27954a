#include "polar/fusion/pose_search.hpp"

#include <algorithm>
#include <numeric>

#include "polar/flames/local_minima.hpp"

namespace polar {

namespace {

// Uphill, at most `steps` of them, over the turns and shifts.
void climb(const DirectionVolumes& volumes, const SearchView& view, const std::vector<Eigen::Matrix3f>& turns,
           const std::vector<Eigen::Vector3f>& shifts, int steps, LookedUpPose& at) {
  std::vector<Eigen::Vector3f> around(shifts.size());
  std::vector<float> there(shifts.size());
  for (int s = 0; s < steps; ++s) {
    LookedUpPose best = at;
    for (std::size_t a = 0; a < shifts.size(); ++a) around[a] = at.translation + shifts[a];
    volumes.scores(view, volumes.direction_of(view, at.rotation), at.rotation, around, there.data());
    for (std::size_t a = 0; a < shifts.size(); ++a)
      if (there[a] > best.score) best = {at.rotation, around[a], there[a]};
    for (const Eigen::Matrix3f& t : turns) {
      const Eigen::Matrix3f r = t * at.rotation;
      const float score = volumes.score(view, volumes.direction_of(view, r), r, at.translation);
      if (score > best.score) best = {r, at.translation, score};
    }
    if (best.score <= at.score) break;
    at = best;
  }
}

std::vector<Eigen::Matrix3f> axis_turns(float angle, bool planar) {
  std::vector<Eigen::Matrix3f> out;
  for (int a = planar ? 2 : 0; a < 3; ++a)
    for (const float sign : {-1.0f, 1.0f})
      out.push_back(Eigen::AngleAxisf(sign * angle, Eigen::Vector3f::Unit(a)).toRotationMatrix());
  return out;
}

std::vector<Eigen::Vector3f> moves(float shift, bool planar) {
  const std::vector<Eigen::Vector3f> all = axis_shifts(shift, planar);
  return {all.begin() + 1, all.end()};  // the first is none
}

}  // namespace

LookedUpPose climbed(const DirectionVolumes& volumes, const SearchView& view, const Pose& start, float turn,
                     float shift, bool planar) {
  constexpr int kMostSteps = 4;
  LookedUpPose at{start.rotation.cast<float>(), start.translation.cast<float>(), 0};
  at.score = volumes.score(view, volumes.direction_of(view, at.rotation), at.rotation, at.translation);
  for (int halves = 0; halves < 3; ++halves, turn *= 0.5f, shift *= 0.5f)
    climb(volumes, view, axis_turns(turn, planar), moves(shift, planar), kMostSteps, at);
  return at;
}

std::vector<Eigen::Vector3f> axis_shifts(float shift, bool planar) {
  std::vector<Eigen::Vector3f> out = {Eigen::Vector3f::Zero()};
  for (int a = 0; a < (planar ? 2 : 3); ++a)
    for (const float sign : {-1.0f, 1.0f}) out.push_back(sign * shift * Eigen::Vector3f::Unit(a));
  return out;
}

GridScores score_grid(const DirectionVolumes& volumes, const SearchView& view, const SearchGrid& grid,
                      const Eigen::Matrix3f& turn, const SearchOptions& options) {
  const std::size_t n = grid.rotation.size();
  GridScores out;
  out.log_likelihood.resize(n);
  out.translation.resize(n);
  std::vector<Eigen::Matrix3f> turned(n);
  std::vector<std::vector<std::size_t>> by_direction(static_cast<std::size_t>(volumes.directions()));
  for (std::size_t i = 0; i < n; ++i) {
    turned[i] = grid.rotation[i] * turn;
    by_direction[static_cast<std::size_t>(volumes.direction_of(view, turned[i]))].push_back(i);
  }
  // All rotations that read one volume in a row: it then stays in the cache.
  std::vector<float> there(options.translation.size());
  for (std::size_t d = 0; d < by_direction.size(); ++d)
    for (const std::size_t i : by_direction[d]) {
      volumes.scores(view, static_cast<int>(d), turned[i], options.translation, there.data());
      const auto best = std::max_element(there.begin(), there.end());  // the first of equal ones
      out.log_likelihood[i] = *best;
      out.translation[i] = options.translation[static_cast<std::size_t>(best - there.begin())];
    }
  if (options.step <= 0 || options.promising <= 0) return out;
  constexpr int kMostShifts = 6;  // of one size
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  const std::size_t few = std::min(n, static_cast<std::size_t>(options.promising));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(few), order.end(),
                    [&](int a, int b) {
                      const float sa = out.log_likelihood[static_cast<std::size_t>(a)],
                                  sb = out.log_likelihood[static_cast<std::size_t>(b)];
                      return sa > sb || (sa == sb && a < b);
                    });
  for (std::size_t k = 0; k < few; ++k) {
    const auto i = static_cast<std::size_t>(order[k]);
    LookedUpPose at{turned[i], out.translation[i], out.log_likelihood[i]};
    for (const float step : {options.step, 0.5f * options.step})
      climb(volumes, view, {}, moves(step, false), kMostShifts, at);
    out.translation[i] = at.translation, out.log_likelihood[i] = at.score;
  }
  return out;
}

std::vector<Pose> basins(const GridScores& scores, const SearchGrid& grid, const Eigen::Matrix3f& turn,
                         int most) {
  std::vector<float> cost(scores.log_likelihood.size());
  std::transform(scores.log_likelihood.begin(), scores.log_likelihood.end(), cost.begin(),
                 [](float s) { return -s; });
  std::vector<Pose> out;
  for (const int i : local_minima(cost, grid.graph, most)) {
    const auto k = static_cast<std::size_t>(i);
    out.push_back({(grid.rotation[k] * turn).cast<double>(), scores.translation[k].cast<double>()});
  }
  return out;
}

}  // namespace polar
