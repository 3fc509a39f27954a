#include "polar/core/isa.hpp"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cstring>

namespace polar {

namespace {
Isa from_environment() {
  const char* wish = std::getenv("POLAR_ISA");
  if (wish && std::strcmp(wish, "portable") == 0) return Isa::portable;
  if (wish && std::strcmp(wish, "avx2") == 0) return Isa::avx2;
  return Isa::avx512;
}
std::atomic<Isa>& most() {
  static std::atomic<Isa> value{from_environment()};
  return value;
}
}  // namespace

Isa detected_isa() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    return Isa::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Isa::avx2;
#endif
  return Isa::portable;
}

Isa active_isa() { return std::min(detected_isa(), most().load()); }

void limit_isa(Isa limit) { most() = limit; }

const char* name(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return "avx512";
    case Isa::avx2:
      return "avx2";
    case Isa::portable:
      break;
  }
  return "portable";
}

}  // namespace polar
