// Compiled once per instruction set (cmake/layers.cmake); includes nothing that could leave an inline
// function of the wrong set behind for the linker.
#include "mixture_kernel.hpp"

#define POLAR_JOIN_(a, b) a##b
#define POLAR_JOIN(a, b) POLAR_JOIN_(a, b)

namespace polar::kernel {
namespace {

typedef float V __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef int I __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef short S __attribute__((vector_size(2 * kLanes), aligned(2), may_alias));

constexpr float kCutOff = 4.0f;        // a Gaussian beyond 4 standard deviations is nothing
constexpr float kMaxBlocks = 4096;     // 65,536 centres
constexpr float kRound = 12582912.0f;  // 1.5 x 2^23: adding it rounds to an integer

inline V load(const float* p) { return *reinterpret_cast<const V*>(p); }
inline void store(float* p, V v) { *reinterpret_cast<V*>(p) = v; }
inline V splat(float v) { return v - V{}; }

inline V exp_of(V x) {
  // 2^i 2^f with |f| <= 1/2; the polynomial is the Taylor series of 2^f to degree 6 (1e-7 relative).
  x = x < -87.0f ? splat(-87.0f) : x;
  const V t = x * 1.44269504088896341f;
  const V i = (t + kRound) - kRound;
  const V f = t - i;
  V p = splat(1.5403530393e-4f);
  p = p * f + 1.3333558146e-3f;
  p = p * f + 9.6181291076e-3f;
  p = p * f + 5.5504108665e-2f;
  p = p * f + 2.4022650696e-1f;
  p = p * f + 6.9314718056e-1f;
  p = p * f + 1.0f;
  const I bits = (__builtin_convertvector(i, I) + 127) << 23;
  return p * reinterpret_cast<const V&>(bits);
}

inline V log_of(V x) {
  // x = 2^e m with m in [sqrt(1/2), sqrt(2)); ln m = 2 atanh((m-1)/(m+1)), series to degree 9.
  I bits = reinterpret_cast<I&>(x);
  const I e = (bits - 0x3f3504f3) >> 23;
  bits = bits - (e << 23);
  const V m = reinterpret_cast<V&>(bits);
  const V s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  V p = splat(1.0f / 9);
  p = p * s2 + 1.0f / 7;
  p = p * s2 + 1.0f / 5;
  p = p * s2 + 1.0f / 3;
  p = p * s2 + 1.0f;
  return 2.0f * s * p + __builtin_convertvector(e, V) * 0.69314718056f;
}

inline float sum(V v) {
  float a[kLanes];
  store(a, v);
  for (int half = kLanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) a[i] += a[i + half];
  return a[0];
}

inline V quadratic_form(const Localisation& l, V dx, V dy, V dz) {
  return dx * (l.pxx * dx + 2.0f * (l.pxy * dy + l.pxz * dz)) + dy * (l.pyy * dy + 2.0f * l.pyz * dz) +
         l.pzz * (dz * dz);
}

// Blocks that hold a centre within the cut-off, as indices; returns how many.
inline int blocks_in_reach(const Centres& c, const Localisation& l, int* hit) {
  int hits = 0;
  for (int g = 0; g < c.blocks; g += kLanes) {
    const V dx = load(c.block_x + g) - l.x, dy = load(c.block_y + g) - l.y, dz = load(c.block_z + g) - l.z;
    const V radius = load(c.block_radius + g);
    const V far = radius + l.reach, sharp = radius * l.sharpest + kCutOff;
    const I near = (dx * dx + dy * dy + dz * dz < far * far) &
                   (quadratic_form(l, dx, dy, dz) < sharp * sharp) & (radius >= 0.0f);
    for (int i = 0; i < kLanes; ++i) {
      hit[hits] = g + i;
      hits += near[i] & 1;
    }
  }
  return hits;
}

inline V weighted_density(const Centres& c, const Localisation& l, int b) {
  const int k = b * kLanes;
  const V q = quadratic_form(l, load(c.x + k) - l.x, load(c.y + k) - l.y, load(c.z + k) - l.z);
  return load(c.weight + k) * l.norm * exp_of(-0.5f * q);
}

void density(const Centres& c, const Localisation* l, int n, float* out) {
  int hit[static_cast<int>(kMaxBlocks) + kLanes];
  for (int j = 0; j < n; ++j) {
    const int hits = blocks_in_reach(c, l[j], hit);
    V total = splat(0);
    for (int h = 0; h < hits; ++h) total += weighted_density(c, l[j], hit[h]);
    out[j] = sum(total);
  }
}

void moments(const Centres& c, const Localisation* l, int n, Moments* out) {
  int hit[static_cast<int>(kMaxBlocks) + kLanes];
  for (int j = 0; j < n; ++j) {
    const int hits = blocks_in_reach(c, l[j], hit);
    V p = splat(0), mx = p, my = p, mz = p, sxx = p, sxy = p, sxz = p, syy = p, syz = p, szz = p;
    for (int h = 0; h < hits; ++h) {
      const int k = hit[h] * kLanes;
      const V e = weighted_density(c, l[j], hit[h]);
      const V x = load(c.x + k), y = load(c.y + k), z = load(c.z + k);
      const V ex = e * x, ey = e * y, ez = e * z;
      p += e, mx += ex, my += ey, mz += ez;
      sxx += ex * x, sxy += ex * y, sxz += ex * z, syy += ey * y, syz += ey * z, szz += ez * z;
    }
    out[j] = {sum(p), sum(mx), sum(my), sum(mz), sum(sxx), sum(sxy), sum(sxz), sum(syy), sum(syz), sum(szz)};
  }
}

void accumulate(const Centres& c, const Localisation* l, int n, float background, float* sums, float* inlier,
                float* density_out, float* scratch) {
  int hit[static_cast<int>(kMaxBlocks) + kLanes];
  const int stride = c.blocks * kLanes;
  for (int j = 0; j < n; ++j) {
    const Localisation& a = l[j];
    const int hits = blocks_in_reach(c, a, hit);
    V total = splat(0);
    for (int h = 0; h < hits; ++h) {
      const V e = weighted_density(c, a, hit[h]);
      store(scratch + h * kLanes, e);
      total += e;
    }
    const float p = sum(total);
    const float scale = 1.0f / (p + background);
    density_out[j] = p;
    inlier[j] = p * scale;
    const float px = a.pxx * a.x + a.pxy * a.y + a.pxz * a.z;
    const float py = a.pxy * a.x + a.pyy * a.y + a.pyz * a.z;
    const float pz = a.pxz * a.x + a.pyz * a.y + a.pzz * a.z;
    const float term[kSums] = {1, a.pxx, a.pxy, a.pxz, a.pyy, a.pyz, a.pzz, px, py, pz};
    for (int h = 0; h < hits; ++h) {
      const V r = load(scratch + h * kLanes) * scale;
      float* at = sums + hit[h] * kLanes;
      for (int s = 0; s < kSums; ++s) store(at + s * stride, load(at + s * stride) + r * term[s]);
    }
  }
}

void add_gaussian_row(float* row, int begin, int end, float amplitude, float a, float b, float c) {
  V i = V{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15} + static_cast<float>(begin);
  int k = begin;
  for (; k + kLanes <= end; k += kLanes, i += static_cast<float>(kLanes))
    store(row + k, load(row + k) + amplitude * exp_of(-0.5f * (a + i * (b + c * i))));
  if (k < end) {
    float rest[kLanes];
    store(rest, amplitude * exp_of(-0.5f * (a + i * (b + c * i))));
    for (int r = 0; k < end; ++k, ++r) row[k] += rest[r];
  }
}

void quantise_log(const float* in, int n, float zero, float scale, short* out) {
  for (int k = 0; k < n; k += kLanes) {  // n is a multiple of 16
    V v = scale * (log_of(load(in + k)) - zero);
    v = v > 32767.0f ? splat(32767.0f) : v;
    v = v < -32767.0f ? splat(-32767.0f) : v;
    v = (v + kRound) - kRound;
    *reinterpret_cast<S*>(out + k) = __builtin_convertvector(__builtin_convertvector(v, I), S);
  }
}

inline V clip(V v, int dim) {
  const float high = static_cast<float>(dim - 1);
  v = v < 0.0f ? splat(0) : v;
  return v > high ? splat(high) : v;
}

void voxel_index(const float* x, const float* y, const float* z, int n, const float* r, const float* t,
                 const int* dim, int* index) {
  for (int k = 0; k < n; k += kLanes) {
    const V a = load(x + k), b = load(y + k), c = load(z + k);
    V u = r[0] * a + r[1] * b + r[2] * c + t[0];
    V v = r[3] * a + r[4] * b + r[5] * c + t[1];
    V w = r[6] * a + r[7] * b + r[8] * c + t[2];
    u = (clip(u, dim[0]) + kRound) - kRound;
    v = (clip(v, dim[1]) + kRound) - kRound;
    w = (clip(w, dim[2]) + kRound) - kRound;
    const I i = __builtin_convertvector(u, I), j = __builtin_convertvector(v, I),
            m = __builtin_convertvector(w, I);
    *reinterpret_cast<I*>(index + k) = (m * dim[1] + j) * dim[0] + i;
  }
}

}  // namespace

const MixtureKernel& POLAR_JOIN(mixture_kernel_, POLAR_ISA)() {
  static constexpr MixtureKernel kernel{density,          moments,      accumulate,
                                        add_gaussian_row, quantise_log, voxel_index};
  return kernel;
}

}  // namespace polar::kernel
