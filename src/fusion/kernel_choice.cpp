#include "kernel_choice.hpp"

#include "polar/core/isa.hpp"

namespace polar {

const kernel::MixtureKernel& mixture_kernel() {
#if defined(__x86_64__)
  switch (active_isa()) {
    case Isa::avx512:
      return kernel::mixture_kernel_avx512();
    case Isa::avx2:
      return kernel::mixture_kernel_avx2();
    case Isa::portable:
      break;
  }
#endif
  return kernel::mixture_kernel_portable();
}

const kernel::LookupKernel& lookup_kernel() {
#if defined(__x86_64__)
  switch (active_isa()) {
    case Isa::avx512:
      return kernel::lookup_kernel_avx512();
    case Isa::avx2:
      return kernel::lookup_kernel_avx2();
    case Isa::portable:
      break;
  }
#endif
  return kernel::lookup_kernel_portable();
}

}  // namespace polar
