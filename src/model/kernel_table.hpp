// The inner loops of the model, one table of functions per instruction set. Free-standing on purpose:
// the translation units behind it are compiled for AVX-512, and an inline function of a standard header
// instantiated there could be the copy that the linker keeps for everyone.
#pragma once

namespace polar::kernel {

constexpr int kPanel = 32;       // columns of a packed panel, a multiple of every set's tile
constexpr int kBlock = 96;       // points encoded together, a multiple of every set's tile rows
constexpr int kHidden1 = 64;     // first layer
constexpr int kHidden2 = 128;    // second layer
constexpr int kLatent = 1024;    // third layer
constexpr int kGramRows = 72;    // kHidden1 rounded up to every set's tile rows
constexpr int kMaxTileRows = 8;  // of every set
constexpr int kScratch = kBlock * (kHidden1 + kHidden2) + kHidden1;  // floats

/// Encoder weights in the layout of the kernels; matrix panels are [columns / kPanel][k][kPanel].
struct EncoderPanels {
  const float* w1;  // [3][kHidden1]
  const float* b1;  // [kHidden1]
  const float* w2;  // panels, k = kHidden1, kHidden2 columns
  const float* b2;  // [kHidden2]
  const float* w3;  // panels, k = kHidden2, kLatent columns
};

struct AdamStep {
  float rate, beta1, beta2, epsilon, decay;  // decay: rate x weight decay
  float correction1, correction2;            // 1 - beta^t
};

struct Table {
  int tile_rows;

  /// C (m x n at most kPanel columns, row stride ldc) = or += A B; A packed as [m / tile_rows][k][tile_rows]
  /// and B as [k][kPanel], both padded with zeros.
  void (*gemm_panel)(int m, int n, int k, const float* a, const float* b, float* c, long ldc,
                     bool accumulate);

  /// First layer of n <= kBlock points (xyz interleaved): h[kBlock][kHidden1], rows past n are zero.
  void (*hidden1)(const EncoderPanels& w, const float* xyz, int n, float* h);

  /// gram[kGramRows][kHidden1] += sum over kBlock rows of h h^T; rows past kHidden1 hold nothing of use.
  /// Reads kHidden1 floats past the last row of h.
  void (*gram)(const float* h, float* gram);

  /// Running maximum over points of the third layer (without its bias) and where it was reached; points
  /// are numbered from `first`. scratch: kScratch floats.
  void (*encode_block)(const EncoderPanels& w, const float* xyz, int n, int first, float* best, int* arg,
                       float* scratch);

  /// sums[4][kHidden1] += sum over points of relu'(h1) * (q + h1 Q) times (1, x, y, z); Q as two panels.
  void (*hidden1_backward)(const EncoderPanels& w, const float* q_panels, const float* q, const float* xyz,
                           int n, float* sums, float* scratch);

  /// For each of n points the nearest of m (m padded to a multiple of 16 with squares so large that they
  /// are never near); arrays x, y, z and half_square = |.|^2 / 2.
  void (*nearest)(int n, const float* x, const float* y, const float* z, int m, const float* mx,
                  const float* my, const float* mz, const float* half_square, int* index);

  /// sum over n of (a - b)^2, times `above` where a lies above b and times `below` elsewhere.
  float (*one_sided)(long n, const float* a, const float* b, float above, float below);

  void (*adamw)(long n, float* w, const float* g, float* m, float* v, const AdamStep& step);
};

const Table& portable_table();
#if defined(__x86_64__)
const Table& avx2_table();
const Table& avx512_table();
#endif

/// The table of polar::active_isa().
const Table& active_table();

}  // namespace polar::kernel
