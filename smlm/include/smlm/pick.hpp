// Particles out of a whole field of view: around given centres, or where localisations are dense.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

struct PickOptions {
  double radius_nm = 0;                // of a pick; it should just hold one particle
  std::string centres;                 // table of x and y, or Picasso's pick regions; empty: they are found
  std::size_t min_localisations = 10;  // of a pick that is found; given centres are kept whatever they hold
};

using Centre = std::array<double, 2>;  // x, y in nm

struct ReadOptions;

/// The centres in a table that any reader understands, or in Picasso's pick regions (.yaml, in camera
/// pixels). What has no unit is in `options.unit`, else in the unit of the picked table's own positions; what
/// that decided is added to the table's warnings and keys.
std::vector<Centre> read_centres(const std::string& path, const ReadOptions& options,
                                 LocalisationTable& table);

/// Local maxima of the number of localisations within the radius, found by mean shift from a grid of that
/// size, densest first, then those left out that lie closer than two radii to a denser one. In ascending x.
std::vector<Centre> find_centres(const LocalisationTable& table, const PickOptions& options);

/// Gives every localisation to the nearest centre within the radius, or to none. Particles are called "1",
/// "2", ... in the order of the centres; what the table said about particles is replaced. Picks without any
/// localisation, and picks that many localisations lie right outside of, are said; Error(input) where every
/// pick is empty.
void pick_particles(LocalisationTable& table, const std::vector<Centre>& centres, double radius_nm);

}  // namespace smlm
