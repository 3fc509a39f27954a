// Numbers about particles that inspection and plausibility are judged by.
#pragma once

#include <vector>

#include "smlm/inspect.hpp"
#include "smlm/localisation_table.hpp"

namespace smlm {

/// One entry a particle with localisations (radii: with more than one), in the table's order.
struct ParticleNumbers {
  std::vector<std::size_t> particle;  // its index in the table
  std::vector<double> localisations;
  std::vector<double> radius_nm;  // root mean square distance from the centroid; NaN of a single localisation
  std::vector<double> lateral_nm;  // standard deviation of the positions along x and y (root mean square)
  std::vector<double> axial_nm;    // and along z
  std::vector<std::uint32_t> file;
};

ParticleNumbers measure_particles(const LocalisationTable& table);

/// Over finite values; NaN where there are none.
Summary summarise(std::vector<double> values);

/// Standard deviations of the localisations along z, or laterally (root mean square of x and y), of every
/// `step`-th row.
std::vector<double> sigmas_nm(const LocalisationTable& table, bool axial, std::size_t step = 1);

}  // namespace smlm
