#include <algorithm>
#include <cmath>

#include "flames_search.hpp"

namespace polar {

namespace {

constexpr int kFastClasses = 3, kExhaustiveClasses = 8;
constexpr double kAlike = 0.05;        // of the radius: noise that differs less is one class
constexpr double kCountWeight = 0.05;  // of the logarithm of the number of points beside it
constexpr int kIterations = 10;        // of k-means

using Feature = Eigen::Matrix<double, 7, 1>;

// The mean covariance as lengths, and the size.
Feature feature_of(const LatentView& view) {
  Eigen::Matrix3f mean = Eigen::Matrix3f::Zero();
  for (const Eigen::Matrix3f& s : view.spread)
    mean += s * s.transpose() / static_cast<float>(view.spread.size());
  const auto length = [&](int a, int b) {
    const double v = static_cast<double>(mean(a, b));
    return std::copysign(std::sqrt(std::abs(v)), v);
  };
  Feature f;
  f << length(0, 0), length(1, 1), length(2, 2), length(0, 1), length(0, 2), length(1, 2),
      kCountWeight * std::log(static_cast<double>(view.points.cols()));
  return f;
}

std::size_t nearest_centre(const std::vector<Feature>& centre, const Feature& f) {
  std::size_t best = 0;
  for (std::size_t c = 1; c < centre.size(); ++c)
    if ((centre[c] - f).squaredNorm() < (centre[best] - f).squaredNorm()) best = c;
  return best;
}

// Farthest-point start, then k-means: no randomness, no order of threads.
std::vector<Feature> centres_of(const std::vector<Feature>& features, std::size_t most) {
  Feature mean = Feature::Zero();
  for (const Feature& f : features) mean += f / static_cast<double>(features.size());
  std::vector<Feature> centre = {mean};
  while (centre.size() < most) {
    double farthest = kAlike;
    const Feature* added = nullptr;
    for (const Feature& f : features) {
      const double d = (f - centre[nearest_centre(centre, f)]).norm();
      if (d > farthest) farthest = d, added = &f;
    }
    if (!added) break;
    centre.push_back(*added);
  }
  for (int it = 0; it < kIterations && centre.size() > 1; ++it) {
    std::vector<Feature> sum(centre.size(), Feature::Zero());
    std::vector<double> count(centre.size(), 0);
    for (const Feature& f : features) {
      const std::size_t c = nearest_centre(centre, f);
      sum[c] += f, count[c] += 1;
    }
    for (std::size_t c = 0; c < centre.size(); ++c)
      if (count[c] > 0) centre[c] = sum[c] / count[c];
  }
  return centre;
}

// Draws like those of the class's views: as many as their mean, each view lends in turn.
void draw_class(const LatentViews& views, NoiseClass& c) {
  double mean = 0;
  for (const int i : c.views)
    mean += static_cast<double>(views.view[static_cast<std::size_t>(i)].source.size()) /
            static_cast<double>(c.views.size());
  const auto draws = static_cast<std::size_t>(std::lround(mean));
  // The view whose own draws are nearest to the mean in number lends its choice of template points.
  const LatentView* lender = nullptr;
  const auto off = [&](const LatentView& v) { return std::abs(static_cast<double>(v.source.size()) - mean); };
  for (const int i : c.views) {
    const LatentView& v = views.view[static_cast<std::size_t>(i)];
    if (!lender || off(v) < off(*lender)) lender = &v;
  }
  c.source.resize(draws);
  c.noise.resize(3, static_cast<Eigen::Index>(draws));
  for (std::size_t j = 0; j < draws; ++j) {
    const LatentView& v = views.view[static_cast<std::size_t>(c.views[j % c.views.size()])];
    c.source[j] = lender->source[j % lender->source.size()];
    c.noise.col(static_cast<Eigen::Index>(j)) = v.noise.col(static_cast<Eigen::Index>(j % v.source.size()));
  }
}

}  // namespace

std::vector<NoiseClass> noise_classes(const LatentViews& views, const LatentOptions& options) {
  const std::vector<int> owner = with_localisations(views);
  std::vector<Feature> features;
  features.reserve(owner.size());
  for (const int i : owner) features.push_back(feature_of(views.view[static_cast<std::size_t>(i)]));
  if (features.empty()) return {};
  const std::vector<Feature> centre =
      centres_of(features, options.search == "exhaustive" ? kExhaustiveClasses : kFastClasses);
  std::vector<NoiseClass> classes(centre.size());
  for (std::size_t k = 0; k < features.size(); ++k)
    classes[nearest_centre(centre, features[k])].views.push_back(owner[k]);
  classes.erase(
      std::remove_if(classes.begin(), classes.end(), [](const NoiseClass& c) { return c.views.empty(); }),
      classes.end());
  for (NoiseClass& c : classes) draw_class(views, c);
  return classes;
}

}  // namespace polar
