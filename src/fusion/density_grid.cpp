#include "polar/fusion/density_grid.hpp"

#include <algorithm>
#include <cmath>

#include "kernel_choice.hpp"

namespace polar {

namespace {

constexpr std::size_t kBlock = kernel::kLookupPad;

// Kernel of a Gaussian in voxels, normalised; one number where it is narrower than can be drawn.
std::vector<float> gaussian_taps(float sigma) {
  if (sigma < 0.2f) return {1};
  const int r = static_cast<int>(std::ceil(3 * sigma));
  std::vector<float> tap(static_cast<std::size_t>(2 * r + 1));
  float sum = 0;
  for (int i = -r; i <= r; ++i) {
    const float z = static_cast<float>(i) / sigma;
    sum += tap[static_cast<std::size_t>(i + r)] = std::exp(-0.5f * z * z);
  }
  for (float& t : tap) t /= sum;
  return tap;
}

// out(.., i, ..) = sum_k tap_k in(.., i - k, ..) along the axis whose neighbours are `stride` apart.
void convolve(const std::vector<float>& in, const std::vector<float>& tap, std::size_t length,
              std::size_t stride, std::vector<float>& out) {
  const auto r = static_cast<std::ptrdiff_t>(tap.size() / 2);
  const auto n = static_cast<std::ptrdiff_t>(length);
  std::fill(out.begin(), out.end(), 0.0f);
  for (std::size_t slab = 0; slab < in.size(); slab += length * stride)
    for (std::ptrdiff_t k = -r; k <= r; ++k) {
      const float w = tap[static_cast<std::size_t>(k + r)];
      const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, k), last = std::min(n, n + k);
      if (first >= last) continue;
      const auto step = static_cast<std::ptrdiff_t>(stride);
      const float* from = in.data() + static_cast<std::ptrdiff_t>(slab) + (first - k) * step;
      float* to = out.data() + static_cast<std::ptrdiff_t>(slab) + first * step;
      const std::ptrdiff_t count = (last - first) * step;
      for (std::ptrdiff_t i = 0; i < count; ++i) to[i] += w * from[i];
    }
}

// -1 of what lies outside any frame: the library's rounding is a call for each of many millions.
int nearest(float x) { return x > -1.0f && x < 65536.0f ? static_cast<int>(x + 1.5f) - 1 : -1; }

}  // namespace

VoxelFrame::VoxelFrame(double reach, double voxel_size, bool planar) {
  const int across =
      (static_cast<int>(std::ceil(2 * reach / voxel_size)) + 3) / 4 * 4;  // rows of 16 in a slab
  dim[0] = dim[1] = across, dim[2] = planar ? 1 : across;
  voxel = static_cast<float>(voxel_size);
  const float half = 0.5f * voxel * static_cast<float>(across - 1);
  origin = {-half, -half, planar ? 0 : -half};
}

void LookupPoints::pad() {
  for (auto* a : {&x, &y, &z})
    if (!a->empty()) a->resize((a->size() + kBlock - 1) / kBlock * kBlock, a->back());
}

void VoxelCounts::add(const LookupPoints& p, const Eigen::Matrix3f& rotation,
                      const Eigen::Vector3f& translation, std::uint32_t weight) {
  const float inverse = 1 / frame_.voxel;
  const Eigen::Matrix3f r = rotation * inverse;
  const Eigen::Vector3f t = (translation - frame_.origin) * inverse;
  for (std::size_t j = 0; j < static_cast<std::size_t>(p.count); ++j) {
    const Eigen::Vector3f at = r * Eigen::Vector3f(p.x[j], p.y[j], p.z[j]) + t;
    const int i = nearest(at.x()), k = nearest(at.y()), l = frame_.planar() ? 0 : nearest(at.z());
    if (i < 0 || k < 0 || l < 0 || i >= frame_.dim[0] || k >= frame_.dim[1] || l >= frame_.dim[2]) continue;
    count_[static_cast<std::size_t>((l * frame_.dim[1] + k) * frame_.dim[0] + i)] += weight;
  }
}

VoxelCounts& VoxelCounts::operator+=(const VoxelCounts& other) {
  for (std::size_t i = 0; i < count_.size(); ++i) count_[i] += other.count_[i];
  return *this;
}

DensityGrid::DensityGrid(const VoxelCounts& counts) : frame_(counts.frame()) {
  value_.assign(counts.count().begin(), counts.count().end());
}

void DensityGrid::blur(double sigma) {
  const std::vector<float> tap = gaussian_taps(static_cast<float>(sigma) / frame_.voxel);
  if (tap.size() == 1) return;
  std::vector<float> out(value_.size());
  std::size_t stride = 1;
  for (int a = 0; a < (frame_.planar() ? 2 : 3); ++a) {
    const auto length = static_cast<std::size_t>(frame_.dim[a]);
    convolve(value_, tap, length, stride, out);
    value_.swap(out);
    stride *= length;
  }
}

Eigen::Vector3f DensityGrid::position(std::size_t v) const {
  const auto nx = static_cast<std::size_t>(frame_.dim[0]), ny = static_cast<std::size_t>(frame_.dim[1]);
  const Eigen::Vector3f at(static_cast<float>(v % nx), static_cast<float>(v / nx % ny),
                           static_cast<float>(v / (nx * ny)));
  return frame_.origin + frame_.voxel * at;
}

void DensityGrid::cap(double share) {
  double mass = 0;
  float low = 0, high = 0;
  for (const float v : value_) mass += static_cast<double>(v), high = std::max(high, v);
  for (int i = 0; i < 24; ++i) {  // to 2^-24 of the highest
    const float middle = 0.5f * (low + high);
    double above = 0;
    for (const float v : value_) above += static_cast<double>(std::max(0.0f, v - middle));
    (above > share * mass ? low : high) = middle;
  }
  for (float& v : value_) v = std::min(v, high);
}

void DensityGrid::normalise(float least) {
  double mass = 0;
  for (const float v : value_) mass += static_cast<double>(v);
  const auto scale = static_cast<float>(1 / (std::max(mass, 1e-30) * static_cast<double>(frame_.volume())));
  for (float& v : value_) v = std::max(least, v * scale);
}

float DensityGrid::at(const Eigen::Vector3f& x) const {
  const Eigen::Vector3f q = (x - frame_.origin) / frame_.voxel;
  int b[3];
  float f[3];
  for (int a = 0; a < 3; ++a) {
    if (a == 2 && frame_.planar()) {
      b[2] = 0, f[2] = 0;
      continue;
    }
    if (!(q[a] >= 0) || q[a] >= static_cast<float>(frame_.dim[a] - 1)) return 0;
    b[a] = static_cast<int>(q[a]), f[a] = q[a] - static_cast<float>(b[a]);
  }
  const std::ptrdiff_t nx = frame_.dim[0], slab = nx * frame_.dim[1];
  const float* v = value_.data() + b[2] * slab + b[1] * nx + b[0];
  const auto bilinear = [&](const float* p) {
    return (p[0] * (1 - f[0]) + p[1] * f[0]) * (1 - f[1]) + (p[nx] * (1 - f[0]) + p[nx + 1] * f[0]) * f[1];
  };
  return frame_.planar() ? bilinear(v) : bilinear(v) * (1 - f[2]) + bilinear(v + slab) * f[2];
}

Eigen::Vector3d DensityGrid::centroid() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double mass = 0;
  for (std::size_t v = 0; v < value_.size(); ++v) {
    const auto w = static_cast<double>(value_[v]);
    sum += w * position(v).cast<double>(), mass += w;
  }
  return sum / std::max(mass, 1e-30);
}

LogVolume::LogVolume(const DensityGrid& density, double outlier_fraction, double outlier_density)
    : frame_(density.frame()) {
  const auto background = static_cast<float>(std::max(outlier_fraction * outlier_density, 1e-12));
  std::vector<float> p = density.value();
  float highest = 0;
  for (float& v : p) {
    v = static_cast<float>(1 - outlier_fraction) * v + background;
    highest = std::max(highest, v);
  }
  zero_ = std::log(background);
  scale_ = 32000.0f / std::max(1.0f, std::log(highest) - zero_);
  p.resize((p.size() + kBlock - 1) / kBlock * kBlock, background);
  value_.resize(p.size() + 1);  // a look-up reads the number after a voxel too
  lookup_kernel().quantise_log(p.data(), static_cast<int>(p.size()), zero_, scale_, value_.data());
}

void LogVolume::scores(const LookupPoints& points, const Eigen::Matrix3f& rotation,
                       const Eigen::Vector3f* translation, std::size_t shifts, float* score) const {
  constexpr std::size_t kBatch = kernel::kMostPoints, kShifts = 64;
  const kernel::LookupKernel& kernel = lookup_kernel();
  const float inverse = 1 / frame_.voxel;
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> r = rotation * inverse;
  float u[kBatch], v[kBatch], w[kBatch];
  Eigen::Vector3f offset[kShifts];
  const auto count = static_cast<std::size_t>(points.count);
  for (std::size_t first = 0; first < shifts; first += kShifts) {
    const std::size_t some = std::min(kShifts, shifts - first);
    for (std::size_t s = 0; s < some; ++s) offset[s] = (translation[first + s] - frame_.origin) * inverse;
    long long total[kShifts];
    std::fill(total, total + some, 0);
    for (std::size_t at = 0; at < count; at += kBatch) {
      const int n = static_cast<int>(std::min(kBatch, count - at));
      kernel.rotate(points.x.data() + at, points.y.data() + at, points.z.data() + at, n, r.data(), u, v, w);
      kernel.nearest_sums(u, v, w, n, offset[0].data(), static_cast<int>(some), frame_.dim, value_.data(),
                          total);
    }
    for (std::size_t s = 0; s < some; ++s)
      score[first + s] = static_cast<float>(static_cast<double>(total[s]) / static_cast<double>(scale_) +
                                            static_cast<double>(zero_) * points.count);
  }
}

float LogVolume::score(const LookupPoints& points, const Eigen::Matrix3f& rotation,
                       const Eigen::Vector3f& translation) const {
  float out = 0;
  scores(points, rotation, &translation, 1, &out);
  return out;
}

}  // namespace polar
