// Fourier shell correlation of two densities (planar: Fourier ring correlation), and the resolution it stands
// for. G. Harauz and M. van Heel, Exact filters for general geometry three dimensional reconstruction, Optik
// 73, 146-156, 1986; the threshold 0.143 after P. Rosenthal and R. Henderson, J. Mol. Biol. 333, 721-745,
// 2003.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "polar/results/render.hpp"

namespace polar {

constexpr double kResolutionThreshold = 0.143;

/// One entry a shell, of width 1 / (edge of the box); the first is at one period a box. Shells end at the
/// Nyquist frequency 1 / (2 voxels).
struct FourierShells {
  std::vector<double> frequency_per_nm;
  std::vector<double> correlation;          // Re sum F1 F2* / sqrt(sum |F1|^2 sum |F2|^2); 0 where nothing is
  std::vector<std::uint64_t> coefficients;  // how many are in the shell
};

/// The volumes must share size, origin and voxel, and have equal edges (planar: one slice). What is drawn
/// must not reach their faces: both volumes would have the cut in common. The same bits for any number of
/// threads. Throws smlm::Error (usage) otherwise.
FourierShells fourier_shells(const Volume& first, const Volume& second);

/// What the shells resolve.
struct ShellResolution {
  /// Period (nm) at which the correlation first falls below the threshold, interpolated linearly in frequency
  /// between shells; NaN where one of the first three shells is already below: nothing is resolved.
  double period_nm = std::numeric_limits<double>::quiet_NaN();
  bool at_nyquist = false;  // never below: the voxels end first, and period_nm is two of them
};
ShellResolution shell_resolution(const FourierShells& shells, double threshold = kResolutionThreshold);

}  // namespace polar
