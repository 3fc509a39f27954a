#include "polar/results/mrc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
constexpr double kAngstromPerNanometre = 10;
constexpr std::size_t kHeaderBytes = 1024;

// The header as 256 words; word n of the paper's table 2 is at n - 1.
class Header {
 public:
  void set(std::size_t word, std::int32_t value) { put(word, static_cast<std::uint32_t>(value)); }
  void set(std::size_t word, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    put(word, bits);
  }
  void text(std::size_t word, const char* text) {
    std::copy(text, text + std::strlen(text), bytes_.begin() + static_cast<std::ptrdiff_t>(4 * (word - 1)));
  }
  std::string bytes() const { return {bytes_.begin(), bytes_.end()}; }

 private:
  void put(std::size_t word, std::uint32_t bits) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[4 * (word - 1) + i] = static_cast<char>(bits >> (8 * i) & 0xff);
  }
  std::array<char, kHeaderBytes> bytes_{};
};

Header header_of(const Volume& v) {
  Header h;
  const auto size = [&](std::size_t axis) { return static_cast<std::int32_t>(v.size[axis]); };
  const auto angstrom = [](double nm) { return static_cast<float>(kAngstromPerNanometre * nm); };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    h.set(1 + axis, size(axis));
    h.set(8 + axis, size(axis));  // sampling: the cell is the box
    h.set(11 + axis, angstrom(v.voxel_nm * static_cast<double>(v.size[axis])));
    h.set(14 + axis, 90.0F);
    h.set(17 + axis, static_cast<std::int32_t>(axis + 1));  // columns, rows, sections are x, y, z
    h.set(50 + axis, angstrom(v.origin_nm[axis]));
  }
  h.set(4, std::int32_t{2});  // 32-bit floats
  double sum = 0, squares = 0;
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : v.density) {
    sum += double(value), squares += double(value) * double(value);
    low = std::min(low, value), high = std::max(high, value);
  }
  const double n = static_cast<double>(v.density.size()), mean = sum / n;
  h.set(20, low), h.set(21, high), h.set(22, static_cast<float>(mean));
  h.set(23, std::int32_t{v.planar ? 0 : 1});  // an image, or a single volume
  h.set(28, std::int32_t{20141});
  h.text(53, "MAP ");
  h.text(54, "DD");  // little endian
  h.set(55, static_cast<float>(std::sqrt(std::max(0.0, squares / n - mean * mean))));
  h.set(56, std::int32_t{1});
  h.text(57, v.planar ? "polar-smlm: localisations per nm^2" : "polar-smlm: localisations per nm^3");
  return h;
}
}  // namespace

void write_mrc(const std::string& path, const Volume& volume) {
  for (const std::size_t size : volume.size)
    if (size > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      throw smlm::Error(smlm::Fault::io, path, "an axis is too long for MRC", "choose a larger voxel");
  std::string content = header_of(volume).bytes();
  content.reserve(content.size() + 4 * volume.density.size());
  for (const float value : volume.density) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i) content += static_cast<char>(bits >> (8 * i) & 0xff);
  }
  smlm::write_file_atomically(path, content);
}

}  // namespace polar
