// The inner loops of the likelihood, free of C++ library types because every instruction set compiles a
// copy of its own. All arrays are float; centres come in blocks of 16 neighbours, blocks in groups of 16.
#pragma once

namespace polar::kernel {

constexpr int kLanes = 16;

// A localisation with its effective covariance C turned into what the density needs.
struct Localisation {
  float x, y, z;
  float pxx, pxy, pxz, pyy, pyz, pzz;  // C^-1
  float norm;                          // (2 pi)^(-d/2) |C|^(-1/2)
  float sharpest;                      // 1 / smallest standard deviation
  float reach;                         // cut-off times the largest standard deviation
};

// The template in the frame of a view. Arrays of centres have 16 x blocks entries, arrays of blocks are
// padded to a multiple of 16 with a negative radius, which no localisation reaches.
struct Centres {
  const float *x, *y, *z, *weight;
  int blocks;
  const float *block_x, *block_y, *block_z, *block_radius;
};

// Per localisation: density, first and second moments of the centres under their weighted densities.
struct Moments {
  float density;
  float mx, my, mz;
  float sxx, sxy, sxz, syy, syz, szz;
};

// Sums of a maximisation step: for each centre 1, C^-1 (6), C^-1 x (3), each times the responsibility.
constexpr int kSums = 10;

struct MixtureKernel {
  // density[j] of each localisation.
  void (*density)(const Centres&, const Localisation*, int n, float* density);
  // moments[j] of each localisation.
  void (*moments)(const Centres&, const Localisation*, int n, Moments* moments);
  // Adds to sums[s * 16 * blocks + k]; responsibilities are weight x density / (total + background).
  // inlier[j] receives total / (total + background), scratch holds 16 x blocks floats.
  void (*accumulate)(const Centres&, const Localisation*, int n, float background, float* sums, float* inlier,
                     float* density, float* scratch);
  // row[i] += amplitude * exp(-(a + b i + c i^2) / 2) for i in [begin, end).
  void (*add_gaussian_row)(float* row, int begin, int end, float amplitude, float a, float b, float c);
  // out[i] = round(scale * (ln(in[i]) - zero)) clipped to int16.
  void (*quantise_log)(const float* in, int n, float zero, float scale, short* out);
  // index[i] of the voxel nearest to rotation x point + offset; rotation is row-major and scaled, so that the
  // result is in voxels; points outside take the border's voxel. Arrays are padded to a multiple of 16.
  void (*voxel_index)(const float* x, const float* y, const float* z, int n, const float* rotation,
                      const float* offset, const int* dim, int* index);
};

const MixtureKernel& mixture_kernel_portable();
const MixtureKernel& mixture_kernel_avx2();
const MixtureKernel& mixture_kernel_avx512();

}  // namespace polar::kernel
