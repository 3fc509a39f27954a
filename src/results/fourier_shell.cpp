#include "polar/results/fourier_shell.hpp"

#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "polar/core/parallel.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using Complex = std::complex<float>;
constexpr std::size_t kLineBlock = 64;  // lines that share a transform's plan
constexpr std::size_t kShellsNeeded = 3;

// Transforms every line along one axis; `stride` between a line's values.
void transform_lines(std::vector<Complex>& field, std::size_t n, std::size_t stride, std::size_t lines) {
  parallel_blocks(lines, kLineBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
    Eigen::FFT<float> fft;
    std::vector<Complex> line(n), spectrum(n);
    for (std::size_t l = begin; l < end; ++l) {
      Complex* first = &field[l / stride * stride * n + l % stride];
      for (std::size_t i = 0; i < n; ++i) line[i] = first[i * stride];
      fft.fwd(spectrum.data(), line.data(), static_cast<Eigen::Index>(n));
      for (std::size_t i = 0; i < n; ++i) first[i * stride] = spectrum[i];
    }
  });
}

std::vector<Complex> spectrum(const Volume& v) {
  std::vector<Complex> field(v.density.begin(), v.density.end());
  const std::size_t n = v.size[0];
  for (std::size_t axis = 0, stride = 1; axis < (v.planar ? 2u : 3u); ++axis, stride *= n)
    transform_lines(field, n, stride, field.size() / n);
  return field;
}

struct Sums {
  std::vector<double> cross, first, second;
  std::vector<std::uint64_t> count;
  explicit Sums(std::size_t shells = 0)
      : cross(shells, 0.0), first(shells, 0.0), second(shells, 0.0), count(shells, 0) {}
  Sums& operator+=(const Sums& o) {
    for (std::size_t s = 0; s < count.size(); ++s)
      cross[s] += o.cross[s], first[s] += o.first[s], second[s] += o.second[s], count[s] += o.count[s];
    return *this;
  }
};

void check(const Volume& a, const Volume& b) {
  const bool same =
      a.size == b.size && a.origin_nm == b.origin_nm && a.voxel_nm == b.voxel_nm && a.planar == b.planar;
  const bool cube =
      a.size[0] == a.size[1] && a.size[2] == (a.planar ? 1 : a.size[0]) && a.size[0] >= 2 * kShellsNeeded;
  if (!same || !cube || a.density.size() != a.size[0] * a.size[1] * a.size[2] ||
      b.density.size() != a.density.size())
    throw smlm::Error(smlm::Fault::usage, "Fourier shells", "the volumes are not two of one cubic grid");
}
}  // namespace

FourierShells fourier_shells(const Volume& a, const Volume& b) {
  check(a, b);
  const std::size_t n = a.size[0], depth = a.size[2], shells = n / 2;
  const std::vector<Complex> first = spectrum(a), second = spectrum(b);
  // Index of a frequency, negative ones in the upper half.
  const auto frequency = [n](std::size_t i) {
    return i <= n / 2 ? static_cast<double>(i) : static_cast<double>(i) - static_cast<double>(n);
  };
  const Sums sums = ordered_sum(depth * n, n, Sums(shells), [&](std::size_t begin, std::size_t end) {
    Sums own(shells);
    for (std::size_t row = begin; row < end; ++row) {
      const double kz = depth > 1 ? frequency(row / n) : 0, ky = frequency(row % n);
      for (std::size_t x = 0; x < n; ++x) {
        const double kx = frequency(x);
        const auto shell = static_cast<std::size_t>(std::lround(std::sqrt(kx * kx + ky * ky + kz * kz)));
        if (shell == 0 || shell > shells) continue;
        const std::complex<double> p(first[row * n + x]), q(second[row * n + x]);
        own.cross[shell - 1] += (p * std::conj(q)).real();
        own.first[shell - 1] += std::norm(p);
        own.second[shell - 1] += std::norm(q);
        ++own.count[shell - 1];
      }
    }
    return own;
  });
  FourierShells out;
  for (std::size_t s = 0; s < shells; ++s) {
    const double power = std::sqrt(sums.first[s] * sums.second[s]);
    out.frequency_per_nm.push_back(static_cast<double>(s + 1) / (static_cast<double>(n) * a.voxel_nm));
    out.correlation.push_back(power > 0 ? sums.cross[s] / power : 0.0);
    out.coefficients.push_back(sums.count[s]);
  }
  return out;
}

ShellResolution shell_resolution(const FourierShells& shells, double threshold) {
  const std::vector<double>& c = shells.correlation;
  const std::vector<double>& f = shells.frequency_per_nm;
  std::size_t s = 0;
  while (s < c.size() && c[s] >= threshold) ++s;
  if (s < kShellsNeeded) return {};
  if (s == c.size()) return {1 / f.back(), true};
  const double share = (c[s - 1] - threshold) / (c[s - 1] - c[s]);
  return {1 / (f[s - 1] + share * (f[s] - f[s - 1]))};
}

}  // namespace polar
