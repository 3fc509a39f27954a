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

/// Of a thing that is compiled once per set, the copy of the set in use.
template <class T>
const T& of_active_isa(const T& (*portable)(), const T& (*avx2)(), const T& (*avx512)()) {
  const Isa isa = active_isa();
  return isa == Isa::avx512 ? avx512() : isa == Isa::avx2 ? avx2() : portable();
}

}  // namespace polar
