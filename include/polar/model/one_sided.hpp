// The distance of two encodings of which one may be lower for a known reason.
#pragma once

#include <Eigen/Core>

namespace polar {

/// Weights of the squared differences where the template's entry lies above the view's, and elsewhere. An
/// entry is a maximum over points, and over fewer points it is lower: a cropped view may lie below its
/// template, and one with outliers above.
struct OneSided {
  float above = 1, below = 1;
};

/// Weighted sum of squared differences of two encodings of one length.
float distance(const Eigen::Ref<const Eigen::VectorXf>& template_latent,
               const Eigen::Ref<const Eigen::VectorXf>& view_latent, OneSided weight);

}  // namespace polar
