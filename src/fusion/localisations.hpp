// A view's localisations in the form the kernels take.
#pragma once

#include <cstdint>
#include <vector>

#include "mixture_kernel.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/effective.hpp"

namespace polar {

using KernelLocalisations = std::vector<kernel::Localisation>;

/// The localisations `subset` of a view (all when empty), in that order.
KernelLocalisations kernel_localisations(const View& view, const Eigen::Vector3f& axis,
                                         const NoiseModel& noise, const std::vector<std::uint32_t>& subset);

}  // namespace polar
