#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "polar/core/median.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/rng.hpp"
#include "polar/latent/loss.hpp"

namespace polar {

namespace {

constexpr std::uint32_t kSampleStage = 51, kNoiseStage = 52, kSourceStage = 53;
constexpr double kRadiusQuantile = 0.98;  // of a view's localisations lie within radius 1 of the autoencoder

// Square root of a covariance (Cholesky; a direction without spread stays without).
Eigen::Matrix3f square_root(const Symmetric3& c) {
  Eigen::Matrix3f l = Eigen::Matrix3f::Zero();
  const auto over = [](float a, float b) { return b > 0 ? a / b : 0.0f; };
  l(0, 0) = std::sqrt(std::max(0.0f, c[0]));
  l(1, 0) = over(c[1], l(0, 0));
  l(2, 0) = over(c[2], l(0, 0));
  l(1, 1) = std::sqrt(std::max(0.0f, c[3] - l(1, 0) * l(1, 0)));
  l(2, 1) = over(c[4] - l(2, 0) * l(1, 0), l(1, 1));
  l(2, 2) = std::sqrt(std::max(0.0f, c[5] - l(2, 0) * l(2, 0) - l(2, 1) * l(2, 1)));
  return l;
}

Symmetric3 mean_covariance(const View& view, const std::vector<std::uint32_t>& which) {
  Symmetric3 mean{};
  for (const std::uint32_t j : which)
    for (std::size_t e = 0; e < 6; ++e) mean[e] += view.covariance[j][e] / static_cast<float>(which.size());
  return mean;
}

std::vector<std::uint32_t> shuffled(std::size_t n, std::size_t most, KeyedRandom& random) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  most = std::min(n, most);
  for (std::size_t j = 0; j < most; ++j) std::swap(order[j], order[j + random.below(n - j)]);
  order.resize(most);
  return order;
}

double radius_of(const View& view, double outlier_fraction) {
  std::vector<float> r;
  for (Eigen::Index j = 0; j < view.points.cols(); ++j) r.push_back(view.points.col(j).norm());
  const double share = kRadiusQuantile * (1 - std::max(0.0, outlier_fraction));
  const auto at = std::min(r.size() - 1, static_cast<std::size_t>(share * static_cast<double>(r.size())));
  std::nth_element(r.begin(), r.begin() + static_cast<std::ptrdiff_t>(at), r.end());
  return static_cast<double>(r[at]);
}

// One scale for all views: relative sizes are part of the structure (paper IV.B).
double common_scale(const Views& views, double outlier_fraction) {
  std::vector<double> radius;
  for (const View& view : views.view)
    if (view.points.cols() > 0) radius.push_back(radius_of(view, outlier_fraction));
  if (radius.empty()) return 1;
  const double median = upper_median(std::move(radius));
  return median > 0 ? 1 / median : 1;
}

}  // namespace

std::vector<int> with_localisations(const LatentViews& views) {
  std::vector<int> out;
  for (std::size_t i = 0; i < views.view.size(); ++i)
    if (!views.view[i].empty()) out.push_back(static_cast<int>(i));
  return out;
}

void set_degradation(LatentView& view, std::uint64_t number, int decoded_points, double visibility,
                     double outlier_fraction, const LatentOptions& options) {
  view.visibility = visibility;
  view.outlier_fraction = outlier_fraction;
  const auto n = static_cast<std::size_t>(view.points.cols());
  if (n == 0) return;
  const auto decoded = static_cast<std::size_t>(decoded_points);
  std::size_t draws = decoded;
  if (options.matched_counts)
    draws = std::max<std::size_t>(
        1,
        static_cast<std::size_t>(std::lround((1 - outlier_fraction) * static_cast<double>(n) / visibility)));
  view.source.clear();
  KeyedRandom sources(options.seed, number, kSourceStage);
  while (view.source.size() < draws)  // every decoded point once before any a second time
    for (const std::uint32_t p : shuffled(decoded, draws - view.source.size(), sources))
      view.source.push_back(static_cast<int>(p));
  view.noise = Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(draws));
  if (options.noise == "none") return;
  KeyedRandom random(options.seed, number, kNoiseStage);
  for (std::size_t j = 0; j < draws; ++j) {
    const double a = random.normal(), b = random.normal(), c = random.normal();
    view.noise.col(static_cast<Eigen::Index>(j)) =
        view.spread[j % n] * Eigen::Vector3d(a, b, c).cast<float>();
  }
}

LatentViews latent_views(const Views& views, const Autoencoder& model, const LatentOptions& options) {
  LatentViews out;
  out.planar = views.planar;
  out.scale = common_scale(views, options.outlier_fraction);
  out.view.resize(views.view.size());
  const auto scale = static_cast<float>(out.scale);
  parallel_for(views.view.size(), [&](std::size_t i) {
    const View& in = views.view[i];
    LatentView& view = out.view[i];
    const auto most = options.matched_counts ? static_cast<std::size_t>(options.localisations)
                                             : std::numeric_limits<std::size_t>::max();
    KeyedRandom random(options.seed, i, kSampleStage);
    const std::vector<std::uint32_t> which = shuffled(in.covariance.size(), most, random);
    const auto n = static_cast<Eigen::Index>(which.size());
    view.points.resize(3, n);
    if (n == 0) return;
    for (Eigen::Index j = 0; j < n; ++j)
      view.points.col(j) = scale * in.points.col(which[static_cast<std::size_t>(j)]);
    view.encoded = model.encode(view.points).latent;
    const bool common = options.noise == "common";
    const Eigen::Matrix3f mean = square_root(mean_covariance(in, which));
    for (const std::uint32_t j : which)
      view.spread.push_back(scale * (common ? mean : square_root(in.covariance[j])));
    if (views.planar)
      for (Eigen::Matrix3f& s : view.spread) s.row(2).setZero();
    set_degradation(view, i, model.decoded_points(), options.visibility > 0 ? options.visibility : 1,
                    std::max(0.0, options.outlier_fraction), options);
  });
  return out;
}

}  // namespace polar
