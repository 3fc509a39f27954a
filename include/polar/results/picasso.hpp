// Picasso's localisation files: NAME.hdf5 with the compound /locs, NAME.yaml and NAME_particles.csv beside
// it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace polar {

/// Picasso's camera pixel that lengths are written in, nm.
constexpr double kPicassoPixel_nm = 130;

/// What must be added to x and y so that no localisation lies outside the image: Picasso drops negative
/// coordinates without a word. Zero where none is.
std::array<double, 2> picasso_shift_nm(const smlm::LocalisationTable& table);

/// Picasso's `group` of each particle: its name where that is a whole number as Picasso would write it, else
/// the smallest number that is free.
std::vector<std::int32_t> picasso_groups(const std::vector<std::string>& names);

/// Writes path (.hdf5), its .yaml, in which an appended document says what was done, and NAME_particles.csv,
/// which says what particle each group is. x, y, lpx, lpy in pixels, z and lpz in nm, `group` as
/// picasso_groups() says. Frame, photons and background come from the table where it has them; what Picasso
/// wants beyond that (sx, sy) is 1. `shift_nm` is added to x and y and kept in the .yaml.
void write_picasso(const std::string& path, const smlm::LocalisationTable& table,
                   const std::array<double, 2>& shift_nm = {0, 0});

}  // namespace polar
