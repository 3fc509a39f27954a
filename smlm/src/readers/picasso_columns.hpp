// What Picasso's columns mean, however they are stored.
#pragma once

#include <algorithm>
#include <cstdint>
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

/// Ids that are whole numbers of up to 64 bits, with a sign or without one. HDF5 clips what a type cannot
/// hold, so that those beyond the signed ones are read a second time; a double would not hold them either.
struct WholeIds {
  std::vector<std::int64_t> id;
  std::vector<std::uint64_t> beyond;  // empty where all fit

  /// `read(T())` gives all of them as T.
  template <class Read>
  explicit WholeIds(const Read& read) : id(read(std::int64_t())) {
    if (std::find(id.begin(), id.end(), INT64_MAX) != id.end()) beyond = read(std::uint64_t());
  }
  std::string text(std::size_t i) const {
    return id[i] == INT64_MAX ? std::to_string(beyond[i]) : std::to_string(id[i]);
  }
};

/// Notes that options.lpz_unit had a say, and warns when lpz was read as nm and its median is so small that
/// it looks like pixels.
void judge_lpz(LocalisationTable& table, const std::vector<SourceColumn>& columns);

}  // namespace smlm::readers
