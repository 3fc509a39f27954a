// Colours of a measurement: the values of the column that a record names.
#pragma once

#include <string>
#include <vector>

#include "polar/results/render.hpp"
#include "raster.hpp"
#include "smlm/localisation_table.hpp"

namespace polar::report {

struct Channel {
  std::string name, style;  // style: of its name in a legend
  Tint tint;
  std::vector<bool> rows;  // which localisations are of it
};

/// One channel of everything where there is no such column, or more than four values.
std::vector<Channel> tinted_channels(const smlm::LocalisationTable& table, const std::string& column);

/// One volume a channel, all of one grid.
std::vector<Volume> volumes_of(const smlm::LocalisationTable& table, const std::vector<Channel>& channels,
                               const RenderOptions& options);

}  // namespace polar::report
