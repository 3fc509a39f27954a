#include "polar/fusion/fusion_data.hpp"

#include "fusion_data_impl.hpp"
#include "polar/core/parallel.hpp"
#include "view_likelihood.hpp"

namespace polar {

namespace {
constexpr std::size_t kBlock = 4;  // views a task
}  // namespace

FusionData::FusionData(const Views& views, const std::vector<Eigen::Vector3f>& axes, const NoiseModel& noise,
                       const Subsets& subsets, const std::vector<int>& which)
    : planar_(noise.planar), impl_(new Impl) {
  const std::size_t n = which.empty() ? views.view.size() : which.size();
  impl_->view.resize(n);
  impl_->visibility.resize(n);
  parallel_blocks(n, kBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
    static const std::vector<std::uint32_t> all;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = which.empty() ? k : static_cast<std::size_t>(which[k]);
      impl_->view[k] =
          kernel_localisations(views.view[i], axes[i], noise, subsets.empty() ? all : subsets[i]);
    }
  });
}

FusionData::~FusionData() = default;
FusionData::FusionData(FusionData&&) noexcept = default;
FusionData& FusionData::operator=(FusionData&&) noexcept = default;

std::size_t FusionData::size() const { return impl_->view.size(); }

void FusionData::set_visibility(std::vector<std::vector<float>> factor) {
  impl_->visibility = std::move(factor);
}

const std::vector<float>& FusionData::visibility(std::size_t view) const { return impl_->visibility[view]; }

const float* view_weight(const FusionData& data, std::size_t view, const float* weight,
                         std::vector<float>& buffer) {
  const std::vector<float>& factor = data.visibility(view);
  if (factor.empty()) return nullptr;
  buffer.resize((factor.size() + kernel::kBlock - 1) / kernel::kBlock * kernel::kBlock, 0.0f);
  for (std::size_t k = 0; k < factor.size(); ++k) buffer[k] = weight[k] * factor[k];
  return buffer.data();
}

std::vector<double> mean_log_likelihood(const Mixture& mixture, const FusionData& data,
                                        const std::vector<Pose>& template_from_view) {
  const BlockedMixture blocked(mixture);
  std::vector<double> mean(data.size(), 0.0);
  parallel_blocks(data.size(), kBlock, [&](std::size_t begin, std::size_t end, std::size_t) {
    ViewFrame frame(blocked);
    std::vector<float> buffer;
    for (std::size_t i = begin; i < end; ++i) {
      const KernelLocalisations& view = data.impl().view[i];
      if (view.empty()) continue;
      mean[i] = log_likelihood(frame, view, template_from_view[i].inverse(), blocked.background(),
                               view_weight(data, i, blocked.weight(), buffer)) /
                static_cast<double>(view.size());
    }
  });
  return mean;
}

double refine_poses(const Mixture& mixture, const FusionData& data, std::vector<Pose>& template_from_view,
                    int evaluations) {
  const BlockedMixture blocked(mixture);
  return ordered_sum(data.size(), kBlock, 0.0, [&](std::size_t begin, std::size_t end) {
    ViewFrame frame(blocked);
    std::vector<float> buffer;
    double total = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (data.impl().view[i].empty()) continue;
      const RefinedPose refined =
          refine_pose(frame, data.impl().view[i], template_from_view[i].inverse(), blocked.background(),
                      data.planar(), evaluations, view_weight(data, i, blocked.weight(), buffer));
      template_from_view[i] = refined.view_from_template.inverse();
      total += refined.log_likelihood;
    }
    return total;
  });
}

}  // namespace polar
