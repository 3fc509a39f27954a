// SHA-256 (FIPS 180-4): names weights, and tells a whole checkpoint from a damaged one.
#pragma once

#include <cstddef>
#include <string>

namespace polar {

/// 64 lower-case hexadecimal digits.
std::string sha256(const void* data, std::size_t bytes);

}  // namespace polar
