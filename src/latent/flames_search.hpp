// FLAMES over the latent distance (paper III.E.a). With t fixed and a common noise, E(nu(R D(z))) does not
// depend on the view, so every rotation is encoded once for all views of a class; the true loss, with each
// view's own draws and masks, then judges the best minima.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "polar/flames/search_grid.hpp"
#include "polar/latent/loss.hpp"

namespace polar {

/// Rotations (view_from_template) as `search` says: fast 1,152, exhaustive the paper's L; planar data: turns
/// about z.
SearchGrid latent_grid(const LatentOptions& options, bool planar);

/// Views whose noise and size are alike and may share coarse scores.
struct NoiseClass {
  std::vector<int> views;
  Eigen::Matrix3Xf noise;   // draws of its views in turn
  std::vector<int> source;  // decoded point of each draw
};
std::vector<NoiseClass> noise_classes(const LatentViews& views, const LatentOptions& options);

struct Minimum {
  Pose view_from_template;
  double loss = 0;  // exact
};

/// The `most` best local minima of every view, best first, at the translation of `pose`. The grid is turned
/// by `turn` first.
std::vector<std::vector<Minimum>> flames(const Autoencoder& model, const LatentViews& views,
                                         const std::vector<NoiseClass>& classes, const SearchGrid& grid,
                                         const Eigen::Matrix3f& turn, const Eigen::Matrix3Xf& template_points,
                                         const std::vector<Pose>& pose, int most);

}  // namespace polar
