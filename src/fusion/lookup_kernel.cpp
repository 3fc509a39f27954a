// Compiled once per instruction set (cmake/layers.cmake), like mixture_kernel.cpp.
#include "lookup_kernel.hpp"

#include "lanes.hpp"

#define POLAR_JOIN_(a, b) a##b
#define POLAR_JOIN(a, b) POLAR_JOIN_(a, b)

namespace polar::kernel {
namespace {

constexpr float kCount[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

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

}  // namespace

const LookupKernel& POLAR_JOIN(lookup_kernel_, POLAR_ISA)() {
  static constexpr LookupKernel kernel{quantise_log, rotate, nearest_sums};
  return kernel;
}

}  // namespace polar::kernel
