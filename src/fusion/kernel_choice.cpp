#include "kernel_choice.hpp"

#include "polar/core/isa.hpp"

namespace polar {

namespace {

template <class Kernel>
using Set = const Kernel& (*)();

template <class Kernel>
const Kernel& active(Set<Kernel> portable, Set<Kernel> avx2, Set<Kernel> avx512) {
  switch (active_isa()) {
    case Isa::avx512:
      return avx512();
    case Isa::avx2:
      return avx2();
    case Isa::portable:
      break;
  }
  return portable();
}

}  // namespace

#if defined(__x86_64__)
#define POLAR_SETS(kernel) kernel##_portable, kernel##_avx2, kernel##_avx512
#else
#define POLAR_SETS(kernel) kernel##_portable, kernel##_portable, kernel##_portable
#endif

const kernel::MixtureKernel& mixture_kernel() {
  return active<kernel::MixtureKernel>(POLAR_SETS(kernel::mixture_kernel));
}

const kernel::LookupKernel& lookup_kernel() {
  return active<kernel::LookupKernel>(POLAR_SETS(kernel::lookup_kernel));
}

}  // namespace polar
