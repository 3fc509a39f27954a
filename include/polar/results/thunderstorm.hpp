// Localisations as ThunderSTORM writes them, for whatever reads its files.
#pragma once

#include <string>

#include "smlm/localisation_table.hpp"

namespace polar {

/// ThunderSTORM's header names and units in its order: id, frame, x, y, (z), sigma (3D: sigma1, sigma2),
/// intensity, offset, bkgstd, uncertainty_xy, (uncertainty_z), and a last column `particle`, which the format
/// has no name for. uncertainty_xy is the root mean square of the standard deviations along x and y. frame
/// counts from 1. Intensity, background (offset) and PSF widths come from the input where it has them;
/// otherwise they are 0, and frame is 1. Lengths with four decimals, in any locale.
std::string format_thunderstorm_csv(const smlm::LocalisationTable& table);

}  // namespace polar
