// Compiled once per instruction set (cmake/layers.cmake); see kernel_table.hpp for what each function does
// and why no standard header is included here.
#include "model/kernel_table.hpp"

#define POLAR_JOIN_(a, b) a##b
#define POLAR_JOIN(a, b) POLAR_JOIN_(a, b)

namespace polar::kernel {
namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 16, kRows = 8;
#elif defined(__AVX2__)
constexpr int kLanes = 8, kRows = 6;
#else
constexpr int kLanes = 4, kRows = 6;
#endif
constexpr int kWidth = 2 * kLanes;  // columns of a register tile

typedef float Vec __attribute__((vector_size(4 * kLanes)));
typedef int Mask __attribute__((vector_size(4 * kLanes)));
typedef float Loose __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));
typedef int LooseMask __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

#define POLAR_INLINE inline __attribute__((always_inline))

POLAR_INLINE Vec load(const float* p) { return *reinterpret_cast<const Loose*>(p); }
POLAR_INLINE void store(float* p, Vec v) { *reinterpret_cast<Loose*>(p) = v; }
POLAR_INLINE Mask load(const int* p) { return *reinterpret_cast<const LooseMask*>(p); }
POLAR_INLINE void store(int* p, Mask v) { *reinterpret_cast<LooseMask*>(p) = v; }
POLAR_INLINE Vec relu(Vec v) { return v > 0.0f ? v : Vec{}; }

/// tile += A B over k: A(r, i) at a[r * row_stride + i * k_stride], B(i, .) at b + i * b_stride.
template <int row_stride, int k_stride, int b_stride>
POLAR_INLINE void multiply(const float* a, const float* b, int k, Vec (&tile)[kRows][2]) {
  for (int i = 0; i < k; ++i, a += k_stride, b += b_stride) {
    const Vec b0 = load(b), b1 = load(b + kLanes);
#pragma GCC unroll 8
    for (int r = 0; r < kRows; ++r) {
      const Vec x = a[r * row_stride] - Vec{};
      tile[r][0] += x * b0;
      tile[r][1] += x * b1;
    }
  }
}

void gemm_panel(int m, int n, int k, const float* a, const float* b, float* c, long ldc, bool accumulate) {
  for (int row = 0; row < m; row += kRows, a += long{kRows} * k)
    for (int column = 0; column < n; column += kWidth) {
      Vec tile[kRows][2] = {};
      multiply<1, kRows, kPanel>(a, b + column, k, tile);
      const int rows = m - row < kRows ? m - row : kRows;
      const int columns = n - column < kWidth ? n - column : kWidth;
      float edge[kRows][kWidth];
#pragma GCC unroll 8
      for (int r = 0; r < kRows; ++r) store(edge[r], tile[r][0]), store(edge[r] + kLanes, tile[r][1]);
      for (int r = 0; r < rows; ++r) {
        float* out = c + (row + r) * ldc + column;
        for (int j = 0; j < columns; ++j) out[j] = accumulate ? out[j] + edge[r][j] : edge[r][j];
      }
    }
}

void hidden1(const EncoderPanels& w, const float* xyz, int n, float* h) {
  for (int c = 0; c < kHidden1; c += kLanes) {
    const Vec wx = load(w.w1 + c), wy = load(w.w1 + kHidden1 + c), wz = load(w.w1 + 2 * kHidden1 + c);
    const Vec b = load(w.b1 + c);
    for (int p = 0; p < n; ++p)
      store(h + p * kHidden1 + c, relu(b + wx * xyz[3 * p] + wy * xyz[3 * p + 1] + wz * xyz[3 * p + 2]));
    for (int p = n; p < kBlock; ++p) store(h + p * kHidden1 + c, Vec{});
  }
}

void gram(const float* h, float* out) {
  for (int row = 0; row < kHidden1; row += kRows)
    for (int column = 0; column < kHidden1; column += kWidth) {
      Vec tile[kRows][2] = {};
      multiply<1, kHidden1, kHidden1>(h + row, h + column, kBlock, tile);
#pragma GCC unroll 8
      for (int r = 0; r < kRows; ++r) {
        float* o = out + (row + r) * kHidden1 + column;
        store(o, load(o) + tile[r][0]);
        store(o + kLanes, load(o + kLanes) + tile[r][1]);
      }
    }
}

/// Rows of h1 and h2 past n repeat nothing of use: they hold relu(b2), and their results are dropped by
/// the caller's row count.
POLAR_INLINE void hidden2(const EncoderPanels& w, const float* h1, int n, float* h2) {
  for (int panel = 0; panel < kHidden2; panel += kPanel)
    for (int row = 0; row < n; row += kRows)
      for (int column = 0; column < kPanel; column += kWidth) {
        const float* bias = w.b2 + panel + column;
        Vec tile[kRows][2];
        const Vec b0 = load(bias), b1 = load(bias + kLanes);
#pragma GCC unroll 8
        for (int r = 0; r < kRows; ++r) tile[r][0] = b0, tile[r][1] = b1;
        multiply<kHidden1, 1, kPanel>(h1 + row * kHidden1, w.w2 + panel * kHidden1 + column, kHidden1, tile);
#pragma GCC unroll 8
        for (int r = 0; r < kRows; ++r) {
          float* o = h2 + (row + r) * kHidden2 + panel + column;
          store(o, relu(tile[r][0]));
          store(o + kLanes, relu(tile[r][1]));
        }
      }
}

void encode_block(const EncoderPanels& w, const float* xyz, int n, int first, float* best, int* arg,
                  float* scratch) {
  float* h1 = scratch;
  float* h2 = scratch + kBlock * kHidden1;
  hidden1(w, xyz, n, h1);
  hidden2(w, h1, n, h2);
  // The rows that round n up to whole tiles repeat the last point, which changes no maximum.
  const int padded = (n + kRows - 1) / kRows * kRows;
  for (int p = n; p < padded; ++p)
    for (int c = 0; c < kHidden2; ++c) h2[p * kHidden2 + c] = h2[(n - 1) * kHidden2 + c];
  for (int panel = 0; panel < kLatent; panel += kPanel)
    for (int column = 0; column < kPanel; column += kWidth) {
      float* out = best + panel + column;
      int* where = arg + panel + column;
      Vec m0 = load(out), m1 = load(out + kLanes);
      Mask i0 = load(where), i1 = load(where + kLanes);
      for (int row = 0; row < padded; row += kRows) {
        Vec tile[kRows][2] = {};
        multiply<kHidden2, 1, kPanel>(h2 + row * kHidden2, w.w3 + panel * kHidden2 + column, kHidden2, tile);
#pragma GCC unroll 8
        for (int r = 0; r < kRows; ++r) {
          const int number = first + (row + r < n ? row + r : n - 1);
          const Mask here = number - Mask{};
          i0 = tile[r][0] > m0 ? here : i0;
          m0 = tile[r][0] > m0 ? tile[r][0] : m0;
          i1 = tile[r][1] > m1 ? here : i1;
          m1 = tile[r][1] > m1 ? tile[r][1] : m1;
        }
      }
      store(out, m0), store(out + kLanes, m1);
      store(where, i0), store(where + kLanes, i1);
    }
}

void hidden1_backward(const EncoderPanels& w, const float* q_panels, const float* q, const float* xyz, int n,
                      float* sums, float* scratch) {
  float* h1 = scratch;
  hidden1(w, xyz, n, h1);  // rows past n are zero, so relu' switches them off
  for (int panel = 0; panel < kHidden1; panel += kPanel)
    for (int column = 0; column < kPanel; column += kWidth) {
      const int c = panel + column;
      Vec s[4][2];
      for (int a = 0; a < 4; ++a)
        s[a][0] = load(sums + a * kHidden1 + c), s[a][1] = load(sums + a * kHidden1 + c + kLanes);
      const Vec q0 = load(q + c), q1 = load(q + c + kLanes);
      for (int row = 0; row < n; row += kRows) {
        Vec tile[kRows][2];
#pragma GCC unroll 8
        for (int r = 0; r < kRows; ++r) tile[r][0] = q0, tile[r][1] = q1;
        multiply<kHidden1, 1, kPanel>(h1 + row * kHidden1, q_panels + panel * kHidden1 + column, kHidden1,
                                      tile);
#pragma GCC unroll 8
        for (int r = 0; r < kRows; ++r) {
          const float* h = h1 + (row + r) * kHidden1 + c;
          const Vec d0 = load(h) > 0.0f ? tile[r][0] : Vec{};
          const Vec d1 = load(h + kLanes) > 0.0f ? tile[r][1] : Vec{};
          const int p = row + r < n ? row + r : n - 1;
          s[0][0] += d0, s[0][1] += d1;
          for (int a = 0; a < 3; ++a) s[a + 1][0] += d0 * xyz[3 * p + a], s[a + 1][1] += d1 * xyz[3 * p + a];
        }
      }
      for (int a = 0; a < 4; ++a)
        store(sums + a * kHidden1 + c, s[a][0]), store(sums + a * kHidden1 + c + kLanes, s[a][1]);
    }
}

/// argmin |p - m|^2 = argmin |m|^2 / 2 - p.m; four points share each load.
void nearest(int n, const float* x, const float* y, const float* z, int m, const float* mx, const float* my,
             const float* mz, const float* half_square, int* index) {
  constexpr int kShare = 4;
  Mask lane;
  for (int l = 0; l < kLanes; ++l) lane[l] = l;
  for (int first = 0; first < n; first += kShare) {
    Vec px[kShare], py[kShare], pz[kShare], best[kShare];
    Mask arg[kShare];
#pragma GCC unroll 4
    for (int s = 0; s < kShare; ++s) {
      const int p = first + s < n ? first + s : n - 1;
      px[s] = x[p] - Vec{}, py[s] = y[p] - Vec{}, pz[s] = z[p] - Vec{};
      best[s] = 3e38f - Vec{};
      arg[s] = Mask{};
    }
    for (int j = 0; j < m; j += kLanes) {
      const Vec qx = load(mx + j), qy = load(my + j), qz = load(mz + j), h = load(half_square + j);
      const Mask here = lane + j;
#pragma GCC unroll 4
      for (int s = 0; s < kShare; ++s) {
        const Vec d = h - px[s] * qx - py[s] * qy - pz[s] * qz;
        arg[s] = d < best[s] ? here : arg[s];
        best[s] = d < best[s] ? d : best[s];
      }
    }
    for (int s = 0; s < kShare && first + s < n; ++s) {
      float least = best[s][0];
      int at = arg[s][0];
      for (int l = 1; l < kLanes; ++l)
        if (best[s][l] < least || (best[s][l] == least && arg[s][l] < at)) least = best[s][l], at = arg[s][l];
      index[first + s] = at;
    }
  }
}

float one_sided(long n, const float* a, const float* b, float above, float below) {
  const Vec up = above - Vec{}, down = below - Vec{};
  Vec s0{}, s1{};
  long i = 0;
  for (; i + kWidth <= n; i += kWidth) {
    const Vec d0 = load(a + i) - load(b + i), d1 = load(a + i + kLanes) - load(b + i + kLanes);
    s0 += (d0 > 0.0f ? up : down) * (d0 * d0);
    s1 += (d1 > 0.0f ? up : down) * (d1 * d1);
  }
  s0 += s1;
  float sum = 0;
  for (int l = 0; l < kLanes; ++l) sum += s0[l];
  for (; i < n; ++i) {
    const float d = a[i] - b[i];
    sum += (d > 0.0f ? above : below) * (d * d);
  }
  return sum;
}

void adamw(long n, float* __restrict w, const float* __restrict g, float* __restrict m, float* __restrict v,
           const AdamStep& step) {
  const AdamStep s = step;
  const float rate = s.rate / s.correction1, scale = 1.0f / s.correction2;
  for (long i = 0; i < n; ++i) {
    m[i] = s.beta1 * m[i] + (1.0f - s.beta1) * g[i];
    v[i] = s.beta2 * v[i] + (1.0f - s.beta2) * g[i] * g[i];
    w[i] -= s.decay * w[i] + rate * m[i] / (__builtin_sqrtf(v[i] * scale) + s.epsilon);
  }
}

const Table kTable = {kRows,   gemm_panel, hidden1, gram, encode_block, hidden1_backward,
                      nearest, one_sided,  adamw};

}  // namespace

const Table& POLAR_JOIN(POLAR_ISA, _table)() { return kTable; }

}  // namespace polar::kernel
