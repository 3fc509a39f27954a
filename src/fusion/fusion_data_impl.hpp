#pragma once

#include <vector>

#include "localisations.hpp"
#include "polar/fusion/fusion_data.hpp"

namespace polar {

struct FusionData::Impl {
  std::vector<KernelLocalisations> view;
  std::vector<std::vector<float>> visibility;
};

/// Weights of a view's centres with its visibility, or null when it has none; `buffer` holds them.
const float* view_weight(const FusionData& data, std::size_t view, const float* weight,
                         std::vector<float>& buffer);

}  // namespace polar
