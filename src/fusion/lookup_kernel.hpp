// The inner loops of scoring by look-up. Sums are whole numbers and nothing is fused, so that every
// instruction set gives the same bits: which mode of a posterior is drawn must not hang on the processor.
#pragma once

namespace polar::kernel {

constexpr int kLookupPad = 16;    // arrays are padded to a multiple of it
constexpr int kMostPoints = 256;  // of one call of nearest_sums: what it keeps fits the first-level cache

struct LookupKernel {
  // out[i] = round(scale * (ln(in[i]) - zero)) clipped to int16.
  void (*quantise_log)(const float* in, int n, float zero, float scale, short* out);
  // u, v, w = rotation x point; rotation is row-major. Arrays are padded to a multiple of 16.
  void (*rotate)(const float* x, const float* y, const float* z, int n, const float* rotation, float* u,
                 float* v, float* w);
  // sum[s] += sum over i < n of the value at the voxel nearest to (u, v, w)_i + offset s, all in voxels;
  // points outside take the border's voxel. `offset` holds three numbers a shift. Arrays are padded to a
  // multiple of 16; n is at most kMostPoints, a volume has at most 2^24 voxels and one number after them.
  void (*nearest_sums)(const float* u, const float* v, const float* w, int n, const float* offset, int shifts,
                       const int* dim, const short* value, long long* sum);
};

const LookupKernel& lookup_kernel_portable();
const LookupKernel& lookup_kernel_avx2();
const LookupKernel& lookup_kernel_avx512();

}  // namespace polar::kernel
