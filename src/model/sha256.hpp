// SHA-256 (FIPS 180-4), to name the weights that a result came from.
#pragma once

#include <cstddef>
#include <string>

namespace polar {

/// 64 lower-case hexadecimal digits.
std::string sha256(const void* data, std::size_t bytes);

}  // namespace polar
