// Compiled once per instruction set (cmake/layers.cmake); includes nothing that could leave an inline
// function of the wrong set behind for the linker.
#include "mixture_kernel.hpp"

#include "lanes.hpp"

#define POLAR_JOIN_(a, b) a##b
#define POLAR_JOIN(a, b) POLAR_JOIN_(a, b)

namespace polar::kernel {
namespace {

constexpr float kCutOff = 4.0f;     // a Gaussian beyond 4 standard deviations is nothing
constexpr float kMaxBlocks = 4096;  // 65,536 centres

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
    for (unsigned bits = bits_of(near); bits != 0; bits &= bits - 1) hit[hits++] = g + __builtin_ctz(bits);
  }
  return hits;
}

// Of the centres k to k + kLanes - 1.
inline V weighted_density(const Centres& c, const Localisation& l, int k) {
  const V q = quadratic_form(l, load(c.x + k) - l.x, load(c.y + k) - l.y, load(c.z + k) - l.z);
  return load(c.weight + k) * l.norm * exp_of(-0.5f * q);
}

void density(const Centres& c, const Localisation* l, int n, float* out) {
  int hit[static_cast<int>(kMaxBlocks) + kBlock];
  for (int j = 0; j < n; ++j) {
    const int hits = blocks_in_reach(c, l[j], hit);
    V total = splat(0);
    for (int h = 0; h < hits; ++h)
      for (int k = hit[h] * kBlock, end = k + kBlock; k < end; k += kLanes)
        total += weighted_density(c, l[j], k);
    out[j] = sum(total);
  }
}

void moments(const Centres& c, const Localisation* l, int n, Moments* out) {
  int hit[static_cast<int>(kMaxBlocks) + kBlock];
  for (int j = 0; j < n; ++j) {
    const int hits = blocks_in_reach(c, l[j], hit);
    V p = splat(0), mx = p, my = p, mz = p, sxx = p, sxy = p, sxz = p, syy = p, syz = p, szz = p;
    for (int h = 0; h < hits; ++h) {
      for (int k = hit[h] * kBlock, end = k + kBlock; k < end; k += kLanes) {
        const V e = weighted_density(c, l[j], k);
        const V x = load(c.x + k), y = load(c.y + k), z = load(c.z + k);
        const V ex = e * x, ey = e * y, ez = e * z;
        p += e, mx += ex, my += ey, mz += ez;
        sxx += ex * x, sxy += ex * y, sxz += ex * z, syy += ey * y, syz += ey * z, szz += ez * z;
      }
    }
    out[j] = {sum(p), sum(mx), sum(my), sum(mz), sum(sxx), sum(sxy), sum(sxz), sum(syy), sum(syz), sum(szz)};
  }
}

void accumulate(const Centres& c, const Localisation* l, int n, float background, float* sums, float* inlier,
                float* density_out, float* scratch) {
  int hit[static_cast<int>(kMaxBlocks) + kBlock];
  const int stride = c.blocks * kBlock;
  for (int j = 0; j < n; ++j) {
    const Localisation& a = l[j];
    const int hits = blocks_in_reach(c, a, hit);
    V total = splat(0);
    for (int h = 0; h < hits; ++h) {
      for (int i = 0; i < kBlock; i += kLanes) {
        const V e = weighted_density(c, a, hit[h] * kBlock + i);
        store(scratch + h * kBlock + i, e);
        total += e;
      }
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
      for (int i = 0; i < kBlock; i += kLanes) {
        const V r = load(scratch + h * kBlock + i) * scale;
        float* at = sums + hit[h] * kBlock + i;
        for (int s = 0; s < kSums; ++s) store(at + s * stride, load(at + s * stride) + r * term[s]);
      }
    }
  }
}

// Whole voxels from `low` to `high` of an axis with `size` of them: [first, last].
struct Span {
  int first, last;
};

inline Span span_of(float low, float high, int size) {
  const float end = static_cast<float>(size - 1);
  if (!(low <= end && high >= 0.0f)) return {0, -1};
  const int below = low > 0.0f ? static_cast<int>(low) : 0;
  return {below + (static_cast<float>(below) < low ? 1 : 0), high < end ? static_cast<int>(high) : size - 1};
}

constexpr float kCount[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

void add_gaussian(float* volume, const int* dim, const VoxelGaussian& g) {
  const float inverse = 1.0f / g.pxx;
  const Span along_z = span_of(g.z - g.extent[2], g.z + g.extent[2], dim[2]);
  const Span along_y = span_of(g.y - g.extent[1], g.y + g.extent[1], dim[1]);
  float middle[kMostRows + kLanes], amplitude[kMostRows + kLanes], room[kMostRows + kLanes];
  for (int z = along_z.first; z <= along_z.last; ++z) {
    const float dz = static_cast<float>(z) - g.z;
    for (int y = along_y.first; y <= along_y.last; y += kLanes) {
      // q = rest + 2 half dx + pxx dx^2 = least + pxx (x - middle)^2 along the row.
      const V dy = load(kCount) + (static_cast<float>(y) - g.y);
      const V half = g.pxy * dy + g.pxz * dz;
      const V rest = g.pyy * dy * dy + 2.0f * g.pyz * dy * dz + g.pzz * dz * dz;
      const V least = rest - half * half * inverse;
      store(middle + y, g.x - half * inverse);
      store(amplitude + y, g.amplitude * exp_of(-0.5f * least));
      store(room + y, (g.reach * g.reach - least) * inverse);
    }
    for (int y = along_y.first; y <= along_y.last; ++y) {
      if (!(room[y] > 0.0f)) continue;
      const float length = __builtin_sqrtf(room[y]);
      const Span chord = span_of(middle[y] - length, middle[y] + length, dim[0]);
      if (chord.first > chord.last) continue;
      const int base = static_cast<int>(middle[y]) - (middle[y] < 0.0f ? 1 : 0);
      const float fraction = middle[y] - static_cast<float>(base);
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): it is not negative, and lround would need a header
      const int phase = static_cast<int>(fraction * static_cast<float>(g.phases) + 0.5f);
      const float* profile = g.profile + phase * g.stride + g.lead - base;
      float* row = volume + (z * dim[1] + y) * dim[0];
      for (int k = chord.first; k <= chord.last; k += kLanes) {
        const V value = amplitude[y] * load(profile + k);
        store(row + k,
              load(row + k) + (load(kCount) <= static_cast<float>(chord.last - k) ? value : splat(0)));
      }
    }
  }
}

// Not a number becomes `low`, so that it is a voxel of the volume still.
inline V clamped(V v, float low, float high) {
  v = v > low ? v : splat(low);
  return v < high ? v : splat(high);
}

void quantise_log(const float* in, int n, float zero, float scale, short* out) {
  for (int k = 0; k < n; k += kLanes) {  // n is a multiple of 16
    V v = scale * (log_of(load(in + k)) - zero);
    v = clamped(v, -32767.0f, 32767.0f);
    v = (v + kRound) - kRound;
    *reinterpret_cast<S*>(out + k) = __builtin_convertvector(__builtin_convertvector(v, I), S);
  }
}

inline V nearest(V v, float high) { return (clamped(v, 0.0f, high) + kRound) - kRound; }

void rotate(const float* x, const float* y, const float* z, int n, const float* r, float* u, float* v,
            float* w) {
  for (int k = 0; k < n; k += kLanes) {
    const V a = load(x + k), b = load(y + k), c = load(z + k);
    store(u + k, r[0] * a + r[1] * b + r[2] * c);
    store(v + k, r[3] * a + r[4] * b + r[5] * c);
    store(w + k, r[6] * a + r[7] * b + r[8] * c);
  }
}

// The values at 2-byte places, one a lane. A gather reads the two bytes after a place too.
inline I gathered(const short* value, I voxel) {
#if defined(__AVX512F__)
  // All lanes are read; the masked form alone does not leave its source undefined.
  const __m512i pair = _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff,
                                                   reinterpret_cast<const __m512i&>(voxel), value, 2);
  return reinterpret_cast<const I&>(pair) << 16 >> 16;
#elif defined(__AVX2__)
  const __m256i pair =
      _mm256_i32gather_epi32(reinterpret_cast<const int*>(value), reinterpret_cast<const __m256i&>(voxel), 2);
  return reinterpret_cast<const I&>(pair) << 16 >> 16;
#else
  I out;
  for (int i = 0; i < kLanes; ++i) out[i] = value[voxel[i]];
  return out;
#endif
}

void nearest_sums(const float* u, const float* v, const float* w, int n, const float* offset, int shifts,
                  const int* dim, const short* value, long long* sum_out) {
  const float width = static_cast<float>(dim[0]), height = static_cast<float>(dim[1]);
  const float high_u = width - 1, high_v = height - 1, high_w = static_cast<float>(dim[2] - 1);
  for (int s = 0; s < shifts; ++s, offset += 3) {
    I total{};
    for (int k = 0; k < n; k += kLanes) {
      const V a = nearest(load(u + k) + offset[0], high_u), b = nearest(load(v + k) + offset[1], high_v),
              c = nearest(load(w + k) + offset[2], high_w);
      const I here = gathered(value, __builtin_convertvector((c * height + b) * width + a, I));
      // Of the padding nothing counts.
      total += n - k >= kLanes ? here : (load(kCount) < static_cast<float>(n - k) ? here : I{});
    }
    long long sum = 0;
    for (int i = 0; i < kLanes; ++i) sum += total[i];
    sum_out[s] += sum;
  }
}

int weighted_densities(const Centres& c, const Localisation& l, int* index, float* density_out) {
  int hit[static_cast<int>(kMaxBlocks) + kBlock];
  const int hits = blocks_in_reach(c, l, hit);
  for (int h = 0; h < hits; ++h) {
    for (int i = 0; i < kBlock; i += kLanes)
      store(density_out + h * kBlock + i, weighted_density(c, l, hit[h] * kBlock + i));
    for (int i = 0; i < kBlock; ++i) index[h * kBlock + i] = hit[h] * kBlock + i;
  }
  return hits;
}

}  // namespace

const MixtureKernel& POLAR_JOIN(mixture_kernel_, POLAR_ISA)() {
  static constexpr MixtureKernel kernel{density,      moments, accumulate,   add_gaussian,
                                        quantise_log, rotate,  nearest_sums, weighted_densities};
  return kernel;
}

}  // namespace polar::kernel
