#include "flames_search.hpp"

#include <algorithm>
#include <cmath>

#include "mask.hpp"
#include "polar/core/parallel.hpp"
#include "polar/flames/local_minima.hpp"

namespace polar {

namespace {

constexpr int kFastRotations = 1152, kFastPlanar = 180;
constexpr std::size_t kTile = 256;       // rotations whose encodings are held at a time
constexpr std::size_t kViewBlock = 512;  // views whose coarse losses are held at a time
constexpr int kJudged = 3;               // times as many minima are judged exactly as are kept
constexpr int kShifts = 2;               // centring steps of a candidate under masks

// Squared distance where the template's entries lie above the view's, and below. A maximum over fewer points
// is lower, so a cropped view may lie below its template, and one with outliers above.
struct OneSided {
  float above = 1, below = 1;
};

OneSided weights_of(const LatentView& view) {
  const auto v = static_cast<float>(view.visibility), o = static_cast<float>(view.outlier_fraction);
  return {v * v, (1 - o) * (1 - o)};
}

float distance(const float* template_latent, const Eigen::VectorXf& view_latent, OneSided weight) {
  float above = 0, below = 0;
  const float* v = view_latent.data();
  for (Eigen::Index c = 0; c < view_latent.size(); ++c) {
    const float d = template_latent[c] - v[c];
    const float up = d > 0 ? d : 0.0f, down = d - up;
    above += up * up;
    below += down * down;
  }
  return weight.above * above + weight.below * below;
}

// Coarse losses of `views` (all of class `c`) over the grid, one row a view.
std::vector<std::vector<float>> coarse(const Autoencoder& model, const LatentViews& views,
                                       const NoiseClass& c, const std::vector<int>& which,
                                       const SearchGrid& grid, const Eigen::Matrix3f& turn,
                                       const Eigen::Matrix3Xf& template_points,
                                       const std::vector<Pose>& pose) {
  // t is fixed: instead of the template the view is shifted, so that one encoding serves every view.
  std::vector<Eigen::VectorXf> wanted(which.size());
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    const Eigen::Vector3f t = pose[i].translation.cast<float>();
    wanted[k] = t.isZero(0) ? views.view[i].encoded : model.encode(views.view[i].points.colwise() - t).latent;
  });
  const std::size_t rotations = grid.rotation.size();
  const Eigen::Matrix3Xf drawn = columns(template_points, c.source);
  std::vector<std::vector<float>> cost(which.size(), std::vector<float>(rotations));
  for (std::size_t first = 0; first < rotations; first += kTile) {
    const std::size_t tile = std::min(kTile, rotations - first);
    Eigen::MatrixXf latent(model.latent_size(), static_cast<Eigen::Index>(tile));
    parallel_for(tile, [&](std::size_t l) {
      latent.col(static_cast<Eigen::Index>(l)) =
          model.encode(grid.rotation[first + l] * turn * drawn + c.noise).latent;
    });
    parallel_for(which.size(), [&](std::size_t k) {
      const OneSided weight = weights_of(views.view[static_cast<std::size_t>(which[k])]);
      for (std::size_t l = 0; l < tile; ++l)
        cost[k][first + l] = distance(latent.col(static_cast<Eigen::Index>(l)).data(), wanted[k], weight);
    });
  }
  return cost;
}

// Under masks the visible part, not the whole, lies where the view is: a few centring steps of what is kept.
Pose centred(const LatentView& view, const Eigen::Matrix3Xf& template_points, Pose pose) {
  if (view.visibility >= 1 && view.outlier_fraction <= 0) return pose;
  for (int step = 0; step < kShifts; ++step) {
    const Eigen::Matrix3Xf cloud = simulated_view(view, template_points, pose);
    const std::vector<int> kept =
        nearest_share(nearest_distances(view.points, cloud), 1 - view.outlier_fraction);
    pose.translation += (columns(view.points, kept).rowwise().mean() - cloud.rowwise().mean()).cast<double>();
  }
  return pose;
}

}  // namespace

SearchGrid latent_grid(const LatentOptions& options, bool planar) {
  const bool exhaustive = options.search == "exhaustive";
  const int usual = planar ? (exhaustive ? kExhaustivePlanarRotations : kFastPlanar)
                           : (exhaustive ? kExhaustiveRotations : kFastRotations);
  return search_grid(options.rotations > 0 ? options.rotations : usual, planar);
}

std::vector<std::vector<Minimum>> flames(const Autoencoder& model, const LatentViews& views,
                                         const std::vector<NoiseClass>& classes, const SearchGrid& grid,
                                         const Eigen::Matrix3f& turn, const Eigen::Matrix3Xf& template_points,
                                         const std::vector<Pose>& pose, int most) {
  std::vector<std::vector<Minimum>> minima(views.view.size());
  for (const NoiseClass& c : classes)
    for (std::size_t first = 0; first < c.views.size(); first += kViewBlock) {
      const auto begin = c.views.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<int> block(
          begin, begin + static_cast<std::ptrdiff_t>(std::min(kViewBlock, c.views.size() - first)));
      const auto cost = coarse(model, views, c, block, grid, turn, template_points, pose);
      parallel_for(block.size(), [&](std::size_t k) {
        const auto i = static_cast<std::size_t>(block[k]);
        std::vector<Minimum>& found = minima[i];
        for (const int l : local_minima(cost[k], grid.graph, kJudged * most)) {
          Pose at = pose[i];
          at.rotation = (grid.rotation[static_cast<std::size_t>(l)] * turn).cast<double>();
          at = centred(views.view[i], template_points, at);
          found.push_back({at, view_loss(model, views.view[i], template_points, at, Derive::nothing).loss});
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const Minimum& a, const Minimum& b) { return a.loss < b.loss; });
        if (found.size() > static_cast<std::size_t>(most)) found.resize(static_cast<std::size_t>(most));
      });
    }
  return minima;
}

}  // namespace polar
