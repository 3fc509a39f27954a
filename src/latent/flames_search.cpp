#include "flames_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "crops.hpp"
#include "mask.hpp"
#include "polar/core/parallel.hpp"
#include "polar/flames/local_minima.hpp"
#include "polar/model/one_sided.hpp"

namespace polar {

namespace {

constexpr int kFastRotations = 1152, kFastPlanar = 180;
constexpr std::size_t kTile = 256;       // rotations whose encodings are held at a time
constexpr std::size_t kViewBlock = 512;  // views whose coarse losses are held at a time
constexpr int kJudged = 3;               // times as many minima are judged exactly as are kept
constexpr double kCropped = 0.95;  // of the template that a class of views shows on the mean: crops are tried
constexpr int kCrops = 12, kCroppedPoints = 128;
constexpr int kShifts = 2;  // centring steps of a candidate under masks

OneSided weights_of(const LatentView& view) {
  const auto v = static_cast<float>(view.visibility), o = static_cast<float>(view.outlier_fraction);
  return {v * v, (1 - o) * (1 - o)};
}

// What a class of views is compared with: the template as it is, or under crops.
std::vector<Crop> versions(const LatentViews& views, const NoiseClass& c, const Eigen::Matrix3Xf& drawn) {
  double visible = 0;
  for (const int i : c.views)
    visible += views.view[static_cast<std::size_t>(i)].visibility / static_cast<double>(c.views.size());
  if (visible <= kCropped) return plane_crops(drawn, visible, kCrops, kCroppedPoints, views.planar);
  Crop whole;
  whole.points = drawn;
  whole.kept.resize(static_cast<std::size_t>(drawn.cols()));
  std::iota(whole.kept.begin(), whole.kept.end(), 0);
  return {whole};
}

// A view as the versions show it, and where its centre was.
struct Wanted {
  Eigen::VectorXf latent;
  Eigen::Vector3f centre;
};

// t is fixed: instead of the template the view is shifted, so that one encoding serves every view. Crops
// have their own centres, and views are then taken about theirs.
Wanted wanted_of(const Autoencoder& model, const LatentView& view, const Pose& pose, bool cropped) {
  const Eigen::Vector3f t = pose.translation.cast<float>();
  if (!cropped) return {t.isZero(0) ? view.encoded : model.encode(view.points.colwise() - t).latent, t};
  const Eigen::Vector3f centre = view.points.rowwise().mean();
  const Eigen::Index n = std::min<Eigen::Index>(kCroppedPoints, view.points.cols());
  return {model.encode(view.points.leftCols(n).colwise() - centre).latent, centre};
}

// Coarse losses of one view over the grid, with the version of the template that each is due to.
struct Coarse {
  std::vector<float> cost;
  std::vector<std::uint8_t> version;
  Eigen::Vector3f centre;
};

std::vector<Coarse> coarse(const Autoencoder& model, const LatentViews& views, const NoiseClass& c,
                           const std::vector<Crop>& versions, const std::vector<int>& which,
                           const SearchGrid& grid, const Eigen::Matrix3f& turn,
                           const std::vector<Pose>& pose) {
  const bool cropped = versions.size() > 1;
  const std::size_t rotations = grid.rotation.size(), n = versions.size();
  std::vector<Eigen::VectorXf> wanted(which.size());
  std::vector<Coarse> out(which.size());
  parallel_for(which.size(), [&](std::size_t k) {
    const auto i = static_cast<std::size_t>(which[k]);
    Wanted w = wanted_of(model, views.view[i], pose[i], cropped);
    wanted[k] = std::move(w.latent);
    out[k] = {std::vector<float>(rotations, INFINITY), std::vector<std::uint8_t>(rotations), w.centre};
  });
  std::vector<Eigen::Matrix3Xf> noise;
  noise.reserve(n);
  for (const Crop& v : versions) noise.push_back(columns(c.noise, v.kept));
  for (std::size_t first = 0; first < rotations * n; first += kTile) {
    const std::size_t tile = std::min(kTile, rotations * n - first);
    Eigen::MatrixXf latent(model.latent_size(), static_cast<Eigen::Index>(tile));
    parallel_for(tile, [&](std::size_t l) {
      const std::size_t at = (first + l) / n, v = (first + l) % n;
      latent.col(static_cast<Eigen::Index>(l)) =
          model.encode(grid.rotation[at] * turn * versions[v].points + noise[v]).latent;
    });
    parallel_for(which.size(), [&](std::size_t k) {
      OneSided weight = weights_of(views.view[static_cast<std::size_t>(which[k])]);
      if (cropped) weight.above = 1;  // a crop hides what the view does not show
      for (std::size_t l = 0; l < tile; ++l) {
        const std::size_t at = (first + l) / n;
        const float d = distance(latent.col(static_cast<Eigen::Index>(l)), wanted[k], weight);
        if (!(d < out[k].cost[at])) continue;
        out[k].cost[at] = d;
        out[k].version[at] = static_cast<std::uint8_t>((first + l) % n);
      }
    });
  }
  return out;
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
  for (const NoiseClass& c : classes) {
    const std::vector<Crop> templates = versions(views, c, columns(template_points, c.source));
    for (std::size_t first = 0; first < c.views.size(); first += kViewBlock) {
      const auto begin = c.views.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<int> block(
          begin, begin + static_cast<std::ptrdiff_t>(std::min(kViewBlock, c.views.size() - first)));
      const auto found_coarsely = coarse(model, views, c, templates, block, grid, turn, pose);
      parallel_for(block.size(), [&](std::size_t k) {
        const auto i = static_cast<std::size_t>(block[k]);
        std::vector<Minimum>& found = minima[i];
        const Coarse& coarsely = found_coarsely[k];
        for (const int l : local_minima(coarsely.cost, grid.graph, kJudged * most)) {
          const auto node = static_cast<std::size_t>(l);
          const Eigen::Matrix3f rotation = grid.rotation[node] * turn;
          Pose at;
          at.rotation = rotation.cast<double>();
          at.translation =
              (coarsely.centre - rotation * templates[coarsely.version[node]].centre).cast<double>();
          at = centred(views.view[i], template_points, at);
          found.push_back({at, view_loss(model, views.view[i], template_points, at, Derive::nothing).loss});
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const Minimum& a, const Minimum& b) { return a.loss < b.loss; });
        if (found.size() > static_cast<std::size_t>(most)) found.resize(static_cast<std::size_t>(most));
      });
    }
  }
  return minima;
}

}  // namespace polar
