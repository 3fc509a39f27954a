// The template blurred once for each of a set of directions, so that a pose costs one look-up a localisation.
// Where lateral sigmas agree, R^T S R = s_xy^2 I + (s_z^2 - s_xy^2) e e^T depends on the direction e = R^T z
// of the optical axis only: every in-plane rotation and every shift reads the same volume. Localisations are
// put into a few classes of equal uncertainty. Densities are kept as 16-bit logarithms and added as integers,
// so a score is the same on every machine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "polar/core/view.hpp"
#include "polar/fusion/effective.hpp"
#include "polar/fusion/mixture.hpp"

namespace polar {

/// Classes of uncertainty that share a volume: effective standard deviations, template width included.
struct SigmaClasses {
  std::vector<AxialSigma> sigma;
  /// Class of one localisation.
  int of(const AxialSigma& effective) const;
};

/// At most `most` classes covering the effective uncertainties of the views.
SigmaClasses sigma_classes(const Views& views, const std::vector<Eigen::Vector3f>& axes,
                           const NoiseModel& noise, int most);

/// A view's localisations, sorted by class, arrays padded to 16 within each class.
struct SearchView {
  struct Part {
    int sigma_class = 0;
    int count = 0;
    std::vector<float> x, y, z;
  };
  std::vector<Part> part;
  Eigen::Vector3f axis = Eigen::Vector3f::UnitZ();
  int count = 0;
};

SearchView search_view(const View& view, const Eigen::Vector3f& axis, const NoiseModel& noise,
                       const SigmaClasses& classes, const std::vector<std::uint32_t>& subset);

class DirectionVolumes {
 public:
  /// Builds classes x directions volumes. `directions` 1: one volume with the mean of the three axes'
  /// variances.
  DirectionVolumes(const Mixture& mixture, const SigmaClasses& classes, int directions, bool planar);

  /// Which direction's volume serves a pose: R is template_from_view.
  int direction_of(const SearchView& view, const Eigen::Matrix3f& rotation) const;
  int directions() const { return static_cast<int>(direction_.size()); }

  /// sum_j ln p(R x_j + t), nearest voxel, in the volume of direction_of(view, R), for each t.
  void scores(const SearchView& view, int direction, const Eigen::Matrix3f& rotation,
              const std::vector<Eigen::Vector3f>& translation, float* score) const;
  float score(const SearchView& view, int direction, const Eigen::Matrix3f& rotation,
              const Eigen::Vector3f& translation) const;

 private:
  const std::int16_t* volume(int sigma_class, int direction) const;

  float voxel_ = 1, zero_ = 0, scale_ = 1;  // ln p = value / scale + zero
  Eigen::Vector3f origin_;                  // of voxel (0, 0, 0)
  int dim_[3] = {1, 1, 1};
  std::size_t stride_ = 0;  // values in one volume, padded to 16
  std::vector<Eigen::Vector3f> direction_;
  std::vector<std::int16_t> value_;
};

/// How many directions resolve the anisotropy of these classes.
int directions_for(const SigmaClasses& classes, bool planar);

}  // namespace polar
