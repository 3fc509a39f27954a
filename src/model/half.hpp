// IEEE 754 half precision as 16-bit patterns.
#pragma once

#include <cstdint>

namespace polar {

/// Nearest half, ties to even; beyond 65504 infinity.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t half);

}  // namespace polar
