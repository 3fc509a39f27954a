// Which instruction set the kernels use: chosen once at run time, never at compile time.
#pragma once

namespace polar {

enum class Isa { portable, avx2, avx512 };

/// Best set that this processor and operating system announce.
Isa detected_isa();

/// The set in use: the detected one unless POLAR_ISA (portable, avx2, avx512) or limit_isa asks for less.
Isa active_isa();

/// Lowers active_isa() for tests and comparisons; asking for more than is detected keeps the detected one.
void limit_isa(Isa most);

const char* name(Isa isa);

}  // namespace polar
