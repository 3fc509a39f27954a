// The superparticle as a density: every localisation is a Gaussian of its own rotated and
// calibrated covariance. The only
// renderer: the volume file and the preview are both made from its volume.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "polar/registration/registration.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

struct RenderOptions {
  double voxel_nm = 0;  // edge of a voxel; 0: half the median of the smallest standard deviations
  /// No axis gets more voxels than this: the voxel grows instead.
  std::size_t most_voxels_per_axis = 256;
  /// sigma_eff^2 = factor^2 sigma^2 + extra^2 across and along the axis of a particle's uncertainties: draws
  /// the precision that the data showed (Registration::calibration), not the one that the table states.
  double lateral_factor = 1, axial_factor = 1, lateral_extra_nm = 0, axial_extra_nm = 0;
  std::string channel_column;  // whose values name each localisation's channel; empty: there is one
};

/// Localisations per nm^3 (planar: per nm^2, one slice), slowest axis z, then y, then x.
struct Volume {
  std::array<std::size_t, 3> size = {0, 0, 0};  // x, y, z
  std::array<double, 3> origin_nm = {0, 0, 0};  // centre of the first voxel
  double voxel_nm = 1;
  bool planar = false;
  std::vector<float> density;
  double wished_voxel_nm = 1;  // smaller where the limits of RenderOptions made the voxel grow

  float at(std::size_t x, std::size_t y, std::size_t z) const {
    return density[(z * size[1] + y) * size[0] + x];
  }
};

/// Options that draw a result with its own calibration.
RenderOptions calibrated_rendering(const Calibration& calibration, double scale_nm);

/// What drawing and fitting need of a table, covariances as calibrated about the axis of each particle's own.
smlm::LocalisationTable calibrated(const smlm::LocalisationTable& stated, const RenderOptions& options);

/// Renders into a box that holds all but the farthest 0.1 % of the localisations on every side, and their
/// spread. The same bits for any number of threads. An empty table gives one empty voxel.
Volume render(const smlm::LocalisationTable& table, const RenderOptions& options = {});

/// Renders into a grid that is given (size, origin, voxel, planar; its density is replaced): two tables in
/// one box.
Volume render_into(Volume grid, const smlm::LocalisationTable& table, const RenderOptions& options = {});

/// What every channel alone looks like.
struct ChannelVolume {
  std::string name;
  Volume volume;
};

/// The density of each channel in the box of all of them; none where options.channel_column is empty. They
/// sum to render()'s, but for localisations without a channel.
std::vector<ChannelVolume> render_channels(const smlm::LocalisationTable& table,
                                           const RenderOptions& options = {});

}  // namespace polar
