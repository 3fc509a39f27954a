// Vectors as wide as the registers and what the kernels do with them. Wider ones would be written the same,
// but GCC takes their comparisons apart lane by lane. Everything is in an unnamed namespace, because every
// instruction set compiles a copy of its own (intrinsics are always inlined).
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "mixture_kernel.hpp"

namespace polar::kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX2__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif
static_assert(kBlock % kLanes == 0, "a block is a whole number of vectors");

typedef float V __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef float V8 __attribute__((vector_size(32), aligned(4), may_alias));
typedef float V4 __attribute__((vector_size(16), aligned(4), may_alias));
typedef int I __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef short S __attribute__((vector_size(2 * kLanes), aligned(2), may_alias));

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

inline V4 halves(V4 v) { return v; }

inline V4 halves(V8 v) {
  return __builtin_shufflevector(v, v, 0, 1, 2, 3) + __builtin_shufflevector(v, v, 4, 5, 6, 7);
}

#if defined(__AVX512F__)
inline V4 halves(V v) {
  return halves(__builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
                __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15));
}
#endif

inline float sum(V v) {
  const V4 a = halves(v);
  return (a[0] + a[2]) + (a[1] + a[3]);
}

// One bit a lane of a comparison's result.
inline unsigned bits_of(I mask) {
#if defined(__AVX512F__)
  return _mm512_movepi32_mask(reinterpret_cast<const __m512i&>(mask));
#elif defined(__AVX2__)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(mask)));
#elif defined(__SSE2__)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<const __m128&>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= (static_cast<unsigned>(mask[i]) & 1u) << i;
  return bits;
#endif
}

}  // namespace
}  // namespace polar::kernel
