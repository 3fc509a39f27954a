// Views that are cut: a plane (of focus, of a section, the edge of a field) takes away what lies beyond it.
// The localisations of a view then come from the template within its half space, of mass v, and their
// density is p(x) / v. Without that division halves laid over each other explain their localisations better
// than the whole structure does, because it spreads its mass over what each of them does not show. Where
// the plane lies is read off the view: no localisation is beyond it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "polar/core/pose.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// A cut that leaves less of the template gains no more: what no plane explains would be thrown away.
constexpr float kLeastShown = 0.2f;

/// How far a view's localisations reach along each of a set of directions (length units of the points, frame
/// of the view); the farthest 1.5 % do not count.
struct ViewReach {
  std::vector<float> farthest;
};
ViewReach reach_of(const Eigen::Matrix3Xf& points);

/// What lies beyond normal . x = offset, in the frame of the view, is cut off.
struct Cut {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitX();
  float offset = std::numeric_limits<float>::infinity();  // nothing is
  float visible = 1;                                      // share of the template's mass on this side
};

/// The template's mass beyond every plane, tabulated.
class CutTable {
 public:
  explicit CutTable(const Mixture& mixture);

  /// Share of the template's mass that the likeliest cut leaves a view, the smallest over the planes behind
  /// which none of its localisations lies: for the rotation of template_from_view and each translation.
  void visible(const ViewReach& reach, const Eigen::Matrix3f& rotation,
               const std::vector<Eigen::Vector3f>& translation, float* share) const;
  /// That cut at one pose.
  Cut likeliest(const ViewReach& reach, const Pose& template_from_view) const;

  /// What `localisations` gain in log likelihood by the cut that leaves this share.
  static float gain(float share, std::size_t localisations);

 private:
  const float* row_of(const Eigen::Vector3f& direction) const;

  std::vector<float> beyond_;  // directions x offsets
};

/// One view under a template, where views are cut; else it holds nothing.
struct CutView {
  const CutTable* cuts = nullptr;
  const ViewReach* reach = nullptr;

  std::optional<Cut> likeliest(const Pose& template_from_view) const {
    return cuts != nullptr ? std::optional(cuts->likeliest(*reach, template_from_view)) : std::nullopt;
  }
};

}  // namespace polar
