#pragma once

#include "lookup_kernel.hpp"
#include "mixture_kernel.hpp"

namespace polar {

/// The kernels of active_isa().
const kernel::MixtureKernel& mixture_kernel();
const kernel::LookupKernel& lookup_kernel();

}  // namespace polar
