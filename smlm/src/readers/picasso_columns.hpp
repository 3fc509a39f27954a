// What Picasso's columns mean, however they are stored.
#pragma once

#include <string>
#include <vector>

#include "../column_plan.hpp"
#include "smlm/localisation_table.hpp"

namespace smlm::readers {

/// x, y, lpx, lpy are in camera pixels, z and lpz in nm (lpz as options.lpz_unit says), group is the
/// particle. sx, sy are widths of the PSF, never uncertainties; whatever is not known is kept as it is.
SourceColumn picasso_column(const std::string& name, const ReadOptions& options);

/// The options with the pixel size of the sidecar where they give none. Error(input) where it has none
/// either.
ReadOptions with_picasso_pixel_size(const std::string& path, const ReadOptions& options);

/// Notes that options.lpz_unit had a say, and warns when lpz was read as nm and its median is so small that
/// it looks like pixels.
void judge_lpz(LocalisationTable& table, const std::vector<SourceColumn>& columns);

}  // namespace smlm::readers
