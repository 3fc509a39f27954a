#pragma once

#include "mixture_kernel.hpp"

namespace polar {

/// The kernels of active_isa().
const kernel::MixtureKernel& mixture_kernel();

}  // namespace polar
