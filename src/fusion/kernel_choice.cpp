#include "kernel_choice.hpp"

#include "polar/core/isa.hpp"

namespace polar {

using kernel::LookupKernel, kernel::MixtureKernel;

#if defined(__x86_64__)
const MixtureKernel& mixture_kernel() {
  return of_active_isa(kernel::mixture_kernel_portable, kernel::mixture_kernel_avx2,
                       kernel::mixture_kernel_avx512);
}
const LookupKernel& lookup_kernel() {
  return of_active_isa(kernel::lookup_kernel_portable, kernel::lookup_kernel_avx2,
                       kernel::lookup_kernel_avx512);
}
#else
const MixtureKernel& mixture_kernel() { return kernel::mixture_kernel_portable(); }
const LookupKernel& lookup_kernel() { return kernel::lookup_kernel_portable(); }
#endif

}  // namespace polar
