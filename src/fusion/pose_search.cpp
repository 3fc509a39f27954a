#include "polar/fusion/pose_search.hpp"

#include <algorithm>
#include <numeric>

#include "polar/flames/local_minima.hpp"

namespace polar {

namespace {

void climb(const DirectionVolumes& volumes, const SearchView& view, const Eigen::Matrix3f& rotation,
           float step, Eigen::Vector3f& translation, float& best) {
  constexpr int kMostSteps = 6;
  const int direction = volumes.direction_of(view, rotation);
  std::vector<float> there;
  for (int half = 0; half < 2; ++half, step *= 0.5f) {
    const std::vector<Eigen::Vector3f> shifts = axis_shifts(step, false);
    for (int s = 0; s < kMostSteps; ++s) {
      const Eigen::Vector3f here = translation;
      std::vector<Eigen::Vector3f> around;
      for (std::size_t a = 1; a < shifts.size(); ++a)
        around.push_back(here + shifts[a]);  // the first is none
      there.resize(around.size());
      volumes.scores(view, direction, rotation, around, there.data());
      for (std::size_t a = 0; a < around.size(); ++a)
        if (there[a] > best) best = there[a], translation = around[a];
      if (translation == here) break;
    }
  }
}

// Uphill over turns about the axes of the template and shifts along them, all of one size.
void climb_pose(const DirectionVolumes& volumes, const SearchView& view, float turn, float shift, bool planar,
                LookedUpPose& at) {
  constexpr int kMostSteps = 4;
  const std::vector<Eigen::Vector3f> shifts = axis_shifts(shift, planar);
  std::vector<Eigen::Matrix3f> turns;
  for (int a = planar ? 2 : 0; a < 3; ++a)
    for (const float sign : {-1.0f, 1.0f})
      turns.push_back(Eigen::AngleAxisf(sign * turn, Eigen::Vector3f::Unit(a)).toRotationMatrix());
  std::vector<Eigen::Vector3f> around(shifts.size() - 1);
  std::vector<float> there(around.size());
  for (int s = 0; s < kMostSteps; ++s) {
    LookedUpPose best = at;
    for (std::size_t a = 0; a < around.size(); ++a) around[a] = at.translation + shifts[a + 1];
    volumes.scores(view, volumes.direction_of(view, at.rotation), at.rotation, around, there.data());
    for (std::size_t a = 0; a < around.size(); ++a)
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

}  // namespace

LookedUpPose climbed(const DirectionVolumes& volumes, const SearchView& view, const Pose& start, float turn,
                     float shift, bool planar) {
  LookedUpPose at{start.rotation.cast<float>(), start.translation.cast<float>(), 0};
  at.score = volumes.score(view, volumes.direction_of(view, at.rotation), at.rotation, at.translation);
  for (int halves = 0; halves < 3; ++halves, turn *= 0.5f, shift *= 0.5f)
    climb_pose(volumes, view, turn, shift, planar, at);
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
    climb(volumes, view, turned[i], options.step, out.translation[i], out.log_likelihood[i]);
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
