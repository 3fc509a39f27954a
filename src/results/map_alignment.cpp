// Two maps onto one another: the second superparticle is one big view of the first one's template.
#include <algorithm>
#include <cmath>

#include "polar/core/covariance3.hpp"
#include "polar/core/rng.hpp"
#include "polar/fusion/search_again.hpp"
#include "polar/results/half_maps.hpp"

namespace polar {

namespace {
constexpr std::uint32_t kOrderStage = 0x81, kTurnStage = 0x82;
constexpr int kRotations = 2304, kPlanarRotations = 360;
constexpr int kSearchLocalisations = 2000;  // of the map; a single view gets 160
constexpr std::size_t kRefineLocalisations = 20000;
constexpr int kRefineEvaluations = 12;
constexpr double kSearchWidth = 0.05;  // in template units: as wide as the grid's spacing asks for
constexpr float kShift = 0.1f, kStep = 0.06f;

// One view about its mean in the template's unit; covariances are the isotropic ones of the same size,
// because particles of all orientations meet in the map.
View map_view(const smlm::LocalisationTable& map, double scale_nm, Eigen::Vector3d& mean_nm) {
  const auto n = static_cast<Eigen::Index>(map.size());
  Eigen::Matrix3Xd x(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& p = map.position_nm[static_cast<std::size_t>(i)];
    x.col(i) << p[0], p[1], map.planar ? 0.0 : p[2];
  }
  mean_nm = x.rowwise().mean();
  View view;
  view.points = ((x.colwise() - mean_nm) / scale_nm).cast<float>();
  const auto unit = static_cast<float>(1 / (scale_nm * scale_nm));
  for (const smlm::Covariance& c : map.covariance_nm2) {
    const float variance = unit * (map.planar ? (c[0] + c[3]) / 2 : (c[0] + c[3] + c[5]) / 3);
    view.covariance.push_back(isotropic_covariance(variance));
  }
  return view;
}

Mixture mixture_of(const FusedTemplate& fused) {
  Mixture m;
  m.centre = fused.centre.cast<float>();
  m.weight = fused.weight.cast<float>();
  m.outlier_fraction = fused.outlier_fraction;
  m.outlier_density = fused.outlier_density;
  sort_into_blocks(m);
  return m;
}

NoiseModel isotropic_noise(const Registration& r, bool planar) {
  const Calibration& c = r.calibration;
  const double axial = planar ? 0 : 1;
  const auto mean = [&](double lateral, double along) {
    return std::sqrt((2 * lateral * lateral + axial * along * along) / (2 + axial));
  };
  NoiseModel noise;
  noise.lateral_factor = noise.axial_factor = mean(c.lateral_factor, c.axial_factor);
  noise.lateral_extra = noise.axial_extra = mean(c.lateral_extra, c.axial_extra);
  noise.width = r.fused.width;
  noise.planar = planar;
  return noise;
}
}  // namespace

Pose align_maps(const Results& first, const Results& second, std::uint64_t seed) {
  const double scale_nm = first.normalisation.scale_nm;
  const bool planar = first.planar;
  Eigen::Vector3d mean_nm;
  Views views;
  views.planar = planar;
  views.view = {map_view(superparticle(second), scale_nm, mean_nm)};
  const std::vector<Eigen::Vector3f> axes = {Eigen::Vector3f::UnitZ()};
  Subsets subset = {
      random_order(static_cast<std::size_t>(views.view[0].points.cols()), KeyedRandom(seed, 0, kOrderStage))};
  const Mixture mixture = mixture_of(first.registration.fused);
  const NoiseModel noise = isotropic_noise(first.registration, planar);

  NoiseModel wide = noise;
  wide.width = std::max(wide.width, kSearchWidth);
  SearchAgainOptions options;
  options.most_localisations = kSearchLocalisations;
  options.grid.translation = axis_shifts(kShift, planar);
  options.grid.step = kStep;
  const Eigen::Matrix3f turn =
      planar ? Eigen::Matrix3f(Eigen::Matrix3f::Identity())
             : Eigen::Matrix3f(KeyedRandom(seed, 0, kTurnStage).rotation().cast<float>());
  std::vector<Pose> pose = {Pose{}};
  search_again(views, axes, subset, mixture, wide,
               search_grid(planar ? kPlanarRotations : kRotations, planar), turn, options, pose);
  subset[0].resize(std::min(subset[0].size(), kRefineLocalisations));
  refine_poses(mixture, FusionData(views, axes, wide, subset), pose, kRefineEvaluations);
  refine_poses(mixture, FusionData(views, axes, noise, subset), pose, kRefineEvaluations);
  return {pose[0].rotation, scale_nm * pose[0].translation - pose[0].rotation * mean_nm};
}

}  // namespace polar
