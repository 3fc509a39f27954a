#include "polar/results/ply.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "smlm/atomic_file.hpp"

namespace polar {

namespace {
constexpr int kBitsPerByte = 8;

template <class T>
void append_little_endian(std::string& bytes, T value) {
  static_assert(sizeof(T) == sizeof(std::uint32_t));
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (std::size_t byte = 0; byte < sizeof bits; ++byte)
    bytes += static_cast<char>(bits >> (kBitsPerByte * static_cast<int>(byte)) & 0xffu);
}

// Geometric mean of the variances along the axes that count, nm^2.
double mean_variance_nm2(const smlm::Covariance& c, bool planar) {
  const double xx = double(c[0]), yy = double(c[3]), zz = double(c[5]);
  return planar ? std::sqrt(xx * yy) : std::cbrt(xx * yy * zz);
}

std::string header(std::size_t rows) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\ncomment polar-smlm, lengths in nm\nelement vertex " +
      std::to_string(rows) + "\n";
  for (const char* name : {"x", "y", "z", "sigma_x", "sigma_y", "sigma_z"})
    text += std::string("property float ") + name + "\n";
  return text + "property int particle\nproperty float weight\nend_header\n";
}
}  // namespace

void write_ply(const std::string& path, const smlm::LocalisationTable& table) {
  std::string bytes = header(table.size());
  double least_nm2 = std::numeric_limits<double>::max();
  for (const smlm::Covariance& c : table.covariance_nm2)
    least_nm2 = std::min(least_nm2, mean_variance_nm2(c, table.planar));
  for (std::size_t row = 0; row < table.size(); ++row) {
    for (const double x : table.position_nm[row]) append_little_endian(bytes, static_cast<float>(x));
    const smlm::Covariance& c = table.covariance_nm2[row];
    append_little_endian(bytes, std::sqrt(c[0]));
    append_little_endian(bytes, std::sqrt(c[3]));
    append_little_endian(bytes, table.planar ? 0.0f : std::sqrt(c[5]));
    append_little_endian(bytes, static_cast<std::int32_t>(table.particle[row]));
    append_little_endian(bytes, static_cast<float>(least_nm2 / mean_variance_nm2(c, table.planar)));
  }
  smlm::write_file_atomically(path, bytes);
}

}  // namespace polar
