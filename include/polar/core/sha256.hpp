// SHA-256 (FIPS 180-4): names weights, and tells a whole checkpoint from a damaged one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace polar {

/// Of bytes that come in parts.
class Sha256 {
 public:
  void add(const void* data, std::size_t bytes);
  /// 64 lower-case hexadecimal digits of all that was added.
  std::string digits() const;

 private:
  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::vector<unsigned char> rest_;  // less than a block
  std::uint64_t bytes_ = 0;
};

/// 64 lower-case hexadecimal digits.
std::string sha256(const void* data, std::size_t bytes);

}  // namespace polar
