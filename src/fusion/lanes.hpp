// Vectors of 16 single-precision lanes and what the kernels do with them. Everything is in an unnamed
// namespace, because every instruction set compiles a copy of its own (intrinsics are always inlined).
#pragma once

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include "mixture_kernel.hpp"

namespace polar::kernel {
namespace {

typedef float V __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef float V8 __attribute__((vector_size(2 * kLanes), aligned(4), may_alias));
typedef float V4 __attribute__((vector_size(kLanes), aligned(4), may_alias));
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

inline float sum(V v) {
  const V8 a = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7) +
               __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
  const V4 b = __builtin_shufflevector(a, a, 0, 1, 2, 3) + __builtin_shufflevector(a, a, 4, 5, 6, 7);
  return (b[0] + b[2]) + (b[1] + b[3]);
}

// One bit a lane of a comparison's result.
inline unsigned bits_of(I mask) {
#if defined(__AVX512F__)
  return static_cast<unsigned>(
      _mm512_test_epi32_mask(reinterpret_cast<const __m512i&>(mask), reinterpret_cast<const __m512i&>(mask)));
#else
  unsigned bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= (static_cast<unsigned>(mask[i]) & 1u) << i;
  return bits;
#endif
}

}  // namespace
}  // namespace polar::kernel
