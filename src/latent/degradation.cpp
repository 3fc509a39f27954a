#include "degradation.hpp"

#include <algorithm>

#include "mask.hpp"
#include "polar/core/parallel.hpp"

namespace polar {

namespace {

// Distances to the nearest of points spread evenly over a surface follow Rayleigh's law, of which 1 in 500
// lies beyond three medians.
constexpr float kFar = 3;
constexpr double kBelieved = 0.5;     // of the share that lies far: the safe side
constexpr double kNegligible = 0.05;  // a smaller share is no degradation
constexpr double kLeastVisibility = 0.5, kMostOutliers = 0.5;

double far_share(Eigen::VectorXf distance) {
  const Eigen::Index n = distance.size(), half = n / 2;
  std::nth_element(distance.data(), distance.data() + half, distance.data() + n);
  const float limit = kFar * distance[half];
  return static_cast<double>((distance.array() > limit).count()) / static_cast<double>(n);
}

double believed(double far) { return far < kNegligible ? 0 : kBelieved * far; }

}  // namespace

void estimate_degradation(const Autoencoder& model, const Eigen::Matrix3Xf& points,
                          const std::vector<Pose>& view_from_template, const LatentOptions& options,
                          LatentViews& views) {
  if (options.visibility > 0 && options.outlier_fraction >= 0) return;
  parallel_for(views.view.size(), [&](std::size_t i) {
    LatentView& view = views.view[i];
    if (view.empty()) return;
    LatentView whole = view;
    set_degradation(whole, i, model.decoded_points(), 1, 0, options);
    const Eigen::Matrix3Xf cloud = simulated_view(whole, points, view_from_template[i]);
    const double hidden = believed(far_share(nearest_distances(cloud, view.points)));
    const double foreign = believed(far_share(nearest_distances(view.points, cloud)));
    set_degradation(
        view, i, model.decoded_points(),
        options.visibility > 0 ? options.visibility : std::max(kLeastVisibility, 1 - hidden),
        options.outlier_fraction >= 0 ? options.outlier_fraction : std::min(kMostOutliers, foreign), options);
  });
}

}  // namespace polar
