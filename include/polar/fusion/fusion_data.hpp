// Localisations of many views under one noise model, ready for the kernels: what a template is fitted to.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/core/view.hpp"
#include "polar/fusion/effective.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// Which localisations of each view take part; an empty list means all of that view.
using Subsets = std::vector<std::vector<std::uint32_t>>;

class FusionData {
 public:
  /// Views `which` (all when empty). `views` and `axes` outlive the object.
  FusionData(const Views& views, const std::vector<Eigen::Vector3f>& axes, const NoiseModel& noise,
             const Subsets& subsets = {}, const std::vector<int>& which = {});
  ~FusionData();
  FusionData(FusionData&&) noexcept;
  FusionData& operator=(FusionData&&) noexcept;

  std::size_t size() const;
  bool planar() const { return planar_; }

  /// Visibility: for every view factors on the weights of the mixture's centres, or none. Normalisation is
  /// the caller's.
  void set_visibility(std::vector<std::vector<float>> factor_of_view);
  const std::vector<float>& visibility(std::size_t view) const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  bool planar_;
  std::unique_ptr<Impl> impl_;
};

/// Mean log density per localisation of every view, poses template_from_view.
std::vector<double> mean_log_likelihood(const Mixture& mixture, const FusionData& data,
                                        const std::vector<Pose>& template_from_view);

/// Moves every pose uphill on its view's likelihood, at most `evaluations` each; returns the sum of log
/// likelihoods after.
double refine_poses(const Mixture& mixture, const FusionData& data, std::vector<Pose>& template_from_view,
                    int evaluations);

}  // namespace polar
