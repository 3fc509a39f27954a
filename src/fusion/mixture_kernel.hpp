// The inner loops of the likelihood, free of C++ library types because every instruction set compiles a
// copy of its own. All arrays are float; centres come in blocks of 16 neighbours, blocks in groups of 16.
#pragma once

namespace polar::kernel {

constexpr int kBlock = 16;  // centres of a block; a multiple of the lanes of every instruction set

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

// A Gaussian in voxels: q = (x - centre)' P (x - centre). It is drawn where q <= reach^2; `extent` are the
// half sides of the box about that ellipsoid. In the plane extent[2], pxz and pyz are 0. All rows of voxels
// cut it to the same profile along x, which is tabulated: profile[f * stride + i] = exp(-pxx (i - lead - f /
// phases)^2 / 2) for f = 0 ... phases, with 16 numbers more than reach.
struct VoxelGaussian {
  float x, y, z;
  float pxx, pxy, pxz, pyy, pyz, pzz;
  float amplitude, reach;
  float extent[3];
  const float* profile;
  int phases, lead, stride;
};

constexpr int kMostRows = 64;  // voxels along y of a volume, at most

struct MixtureKernel {
  // density[j] of each localisation.
  void (*density)(const Centres&, const Localisation*, int n, float* density);
  // moments[j] of each localisation.
  void (*moments)(const Centres&, const Localisation*, int n, Moments* moments);
  // Adds to sums[s * 16 * blocks + k]; responsibilities are weight x density / (total + background).
  // inlier[j] receives total / (total + background), scratch holds 16 x blocks floats.
  void (*accumulate)(const Centres&, const Localisation*, int n, float background, float* sums, float* inlier,
                     float* density, float* scratch);
  // volume += amplitude exp(-q / 2) at the voxels within reach; x is the fastest of the three sizes `dim`.
  // The 15 numbers after a row are rewritten as they are.
  void (*add_gaussian)(float* volume, const int* dim, const VoxelGaussian&);
  // The centres within reach of one localisation: their indices, in whole blocks, and their weighted
  // densities. Returns how many blocks; both arrays have room for all centres.
  int (*weighted_densities)(const Centres&, const Localisation&, int* index, float* density);
};

const MixtureKernel& mixture_kernel_portable();
const MixtureKernel& mixture_kernel_avx2();
const MixtureKernel& mixture_kernel_avx512();

}  // namespace polar::kernel
