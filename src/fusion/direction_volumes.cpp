#include "polar/fusion/direction_volumes.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "kernel_choice.hpp"
#include "polar/core/constants.hpp"
#include "polar/core/parallel.hpp"
#include "polar/core/spiral.hpp"
#include "voxel_gaussian.hpp"

namespace polar {

namespace {

constexpr float kVoxelPerSigma =
    0.8f;  // voxel over the sharpest standard deviation: nearest look-up errs by .23 of it
constexpr int kLargestDim = 56;  // 56^3 16-bit values fit a second-level cache
static_assert(kLargestDim < kernel::kMostRows, "rounding up may add a voxel");
constexpr float kBorderSigmas = 2.0f;    // beyond the outermost centre
constexpr float kReach = 3.5f;           // standard deviations a centre is drawn to
constexpr float kMostIsotropic = 1.25f;  // ratio of standard deviations that one direction still serves
constexpr float kClassRatio = 1.35f;     // uncertainties within this ratio share a class

AxialSigma effective_sigma(const Symmetric3& stated, const Eigen::Vector3f& axis, const NoiseModel& noise) {
  return axial_sigma(effective_covariance(stated, axis, noise), axis);
}

}  // namespace

int SigmaClasses::of(const AxialSigma& s) const {
  int best = 0;
  float least = INFINITY;
  for (std::size_t c = 0; c < sigma.size(); ++c) {
    const float dl = std::log(s.lateral / sigma[c].lateral), da = std::log(s.axial / sigma[c].axial);
    const float d = 2 * dl * dl + da * da;
    if (d < least) least = d, best = static_cast<int>(c);
  }
  return best;
}

SigmaClasses sigma_classes(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                           const NoiseModel& noise, int most) {
  constexpr std::size_t kSamples = 20000;  // quantiles of a sample are enough to place a few classes
  std::size_t total = 0;
  for (const View& v : views.view) total += v.covariance.size();
  const std::size_t step = std::max<std::size_t>(1, total / kSamples);
  std::vector<AxialSigma> sample;
  std::size_t k = 0;
  for (std::size_t i = 0; i < views.view.size(); ++i)
    for (const Symmetric3& c : views.view[i].covariance)
      if (k++ % step == 0) sample.push_back(effective_sigma(c, axes[i], noise));
  std::sort(sample.begin(), sample.end(), [](const AxialSigma& a, const AxialSigma& b) {
    return a.lateral != b.lateral ? a.lateral < b.lateral : a.axial < b.axial;
  });
  const float spread =
      sample.empty() ? 1.0f : sample[sample.size() * 49 / 50].lateral / sample[sample.size() / 50].lateral;
  const int count = std::clamp(1 + static_cast<int>(std::log(spread) / std::log(kClassRatio)), 1, most);
  SigmaClasses classes;
  for (int c = 0; c < count && !sample.empty(); ++c) {
    const std::size_t begin = sample.size() * static_cast<std::size_t>(c) / static_cast<std::size_t>(count);
    const std::size_t end = sample.size() * static_cast<std::size_t>(c + 1) / static_cast<std::size_t>(count);
    AxialSigma mean;
    for (std::size_t i = begin; i < end; ++i) {
      mean.lateral += sample[i].lateral * sample[i].lateral;
      mean.axial += sample[i].axial * sample[i].axial;
    }
    const float n = static_cast<float>(std::max<std::size_t>(1, end - begin));
    classes.sigma.push_back({std::sqrt(mean.lateral / n), std::sqrt(mean.axial / n)});
  }
  if (classes.sigma.empty()) classes.sigma.push_back({1, 1});
  return classes;
}

SearchView search_view(const View& view, const Eigen::Vector3f& axis, const NoiseModel& noise,
                       const SigmaClasses& classes, const std::vector<std::uint32_t>& subset) {
  const std::size_t n = subset.empty() ? view.covariance.size() : subset.size();
  SearchView out;
  out.axis = axis;
  out.count = static_cast<int>(n);
  out.part.resize(classes.sigma.size());
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t j = subset.empty() ? k : subset[k];
    const int c = classes.of(effective_sigma(view.covariance[j], axis, noise));
    SearchView::Part& part = out.part[static_cast<std::size_t>(c)];
    const Eigen::Vector3f x = view.points.col(static_cast<Eigen::Index>(j));
    part.x.push_back(x.x()), part.y.push_back(x.y()), part.z.push_back(x.z());
    part.sigma_class = c;
    ++part.count;
  }
  out.part.erase(std::remove_if(out.part.begin(), out.part.end(), [](const auto& p) { return p.count == 0; }),
                 out.part.end());
  for (SearchView::Part& part : out.part)
    for (auto* a : {&part.x, &part.y, &part.z})
      a->resize((a->size() + kernel::kLookupPad - 1) / kernel::kLookupPad * kernel::kLookupPad, a->back());
  return out;
}

int directions_for(const SigmaClasses& classes, bool planar) {
  float ratio = 1;
  for (const AxialSigma& s : classes.sigma)
    ratio = std::max(ratio, std::max(s.axial / s.lateral, s.lateral / s.axial));
  if (planar || ratio < kMostIsotropic) return 1;
  return ratio < 2 ? 32 : 64;
}

DirectionVolumes::DirectionVolumes(const Mixture& mixture, const SigmaClasses& classes, int directions,
                                   bool planar) {
  direction_ = spiral_directions<float>(directions, Spiral::hemisphere);  // e and -e blur alike
  float sharpest = INFINITY;
  for (const AxialSigma& s : classes.sigma)
    sharpest = std::min({sharpest, s.lateral, planar ? s.lateral : s.axial});
  const Eigen::Vector3f low = mixture.centre.rowwise().minCoeff(), high = mixture.centre.rowwise().maxCoeff();
  const Eigen::Vector3f border = Eigen::Vector3f::Constant(kBorderSigmas * sharpest);
  const Eigen::Vector3f extent = high - low + 2 * border;
  voxel_ = std::max(kVoxelPerSigma * sharpest, extent.maxCoeff() / static_cast<float>(kLargestDim - 1));
  for (int a = 0; a < 3; ++a)
    dim_[a] = planar && a == 2 ? 1 : static_cast<int>(std::ceil(extent[a] / voxel_)) + 1;
  origin_ = low - border;
  if (planar) origin_.z() = 0;
  const auto voxels = static_cast<std::size_t>(dim_[0] * dim_[1] * dim_[2]);
  stride_ = (voxels + kernel::kLookupPad - 1) / kernel::kLookupPad * kernel::kLookupPad;
  value_.resize(stride_ * direction_.size() * classes.sigma.size() + 1);  // a look-up reads one more

  const auto background =
      static_cast<float>(std::max(mixture.outlier_fraction * mixture.outlier_density, 1e-12));
  zero_ = std::log(background);
  const float highest = kTwoPiF * sharpest * sharpest * (planar ? 1 : std::sqrt(kTwoPiF) * sharpest);
  scale_ = 32000.0f / std::max(1.0f, std::log(1.0f / highest + background) - zero_);

  const auto inlier = static_cast<float>(1 - mixture.outlier_fraction);
  parallel_for(direction_.size() * classes.sigma.size(), [&](std::size_t v) {
    const AxialSigma sigma = classes.sigma[v / direction_.size()];
    const Eigen::Vector3f e = direction_[v % direction_.size()];
    const float lat2 = sigma.lateral * sigma.lateral, ax2 = sigma.axial * sigma.axial;
    Eigen::Matrix3f c = lat2 * Eigen::Matrix3f::Identity() + (ax2 - lat2) * e * e.transpose();
    if (planar)
      c = lat2 * Eigen::Matrix3f::Identity();
    else if (direction_.size() == 1)
      c = (2 * lat2 + ax2) / 3 * Eigen::Matrix3f::Identity();
    const float norm =
        planar ? 1 / (kTwoPiF * lat2) : 1 / std::sqrt(kTwoPiF * kTwoPiF * kTwoPiF * c.determinant());
    std::vector<float> density(stride_ + kernel::kBlock, background);  // add_gaussian touches a little more
    const VoxelGaussian gaussian(c, voxel_, kReach, planar);
    for (Eigen::Index k = 0; k < mixture.size(); ++k) {
      const float amplitude = inlier * mixture.weight[k] * norm;
      if (amplitude < 1e-6f * background) continue;
      const Eigen::Vector3f at = (mixture.centre.col(k) - origin_) / voxel_;
      mixture_kernel().add_gaussian(density.data(), dim_, gaussian.at(at, amplitude));
    }
    lookup_kernel().quantise_log(density.data(), static_cast<int>(stride_), zero_, scale_,
                                 value_.data() + v * stride_);
  });
}

const std::int16_t* DirectionVolumes::volume(int sigma_class, int direction) const {
  return value_.data() +
         (static_cast<std::size_t>(sigma_class) * direction_.size() + static_cast<std::size_t>(direction)) *
             stride_;
}

int DirectionVolumes::direction_of(const SearchView& view, const Eigen::Matrix3f& rotation) const {
  const Eigen::Vector3f e = rotation * view.axis;
  int best = 0;
  float most = -1;
  for (std::size_t d = 0; d < direction_.size(); ++d) {
    const float c = std::abs(e.dot(direction_[d]));
    if (c > most) most = c, best = static_cast<int>(d);
  }
  return best;
}

void DirectionVolumes::scores(const SearchView& view, int direction, const Eigen::Matrix3f& rotation,
                              const std::vector<Eigen::Vector3f>& translation, float* score) const {
  constexpr std::size_t kBatch = kernel::kMostPoints, kShifts = 64;  // localisations and shifts at a time
  const kernel::LookupKernel& kernel = lookup_kernel();
  const float inverse = 1 / voxel_;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = rotation * inverse;
  float u[kBatch], v[kBatch], w[kBatch];
  Eigen::Vector3f offset[kShifts];
  for (std::size_t first = 0; first < translation.size(); first += kShifts) {
    const std::size_t shifts = std::min(kShifts, translation.size() - first);
    for (std::size_t s = 0; s < shifts; ++s) offset[s] = (translation[first + s] - origin_) * inverse;
    long long total[kShifts] = {};
    for (const SearchView::Part& part : view.part) {
      const auto count = static_cast<std::size_t>(part.count);
      for (std::size_t at = 0; at < count; at += kBatch) {
        const int n = static_cast<int>(std::min(kBatch, count - at));
        kernel.rotate(part.x.data() + at, part.y.data() + at, part.z.data() + at, n, r.data(), u, v, w);
        kernel.nearest_sums(u, v, w, n, offset[0].data(), static_cast<int>(shifts), dim_,
                            volume(part.sigma_class, direction), total);
      }
    }
    for (std::size_t s = 0; s < shifts; ++s)
      score[first + s] = static_cast<float>(static_cast<double>(total[s]) / static_cast<double>(scale_) +
                                            static_cast<double>(zero_) * view.count);
  }
}

float DirectionVolumes::score(const SearchView& view, int direction, const Eigen::Matrix3f& rotation,
                              const Eigen::Vector3f& translation) const {
  float out = 0;
  scores(view, direction, rotation, {translation}, &out);
  return out;
}

}  // namespace polar
