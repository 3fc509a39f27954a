#include "polar/model/one_sided.hpp"

#include "model/kernel_table.hpp"

namespace polar {

float distance(const Eigen::Ref<const Eigen::VectorXf>& template_latent,
               const Eigen::Ref<const Eigen::VectorXf>& view_latent, OneSided weight) {
  return kernel::active_table().one_sided(view_latent.size(), template_latent.data(), view_latent.data(),
                                          weight.above, weight.below);
}

}  // namespace polar
