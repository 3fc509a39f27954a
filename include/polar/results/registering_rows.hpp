// Of a superparticle of several channels, the part that the poses and the template come from.
#pragma once

#include "smlm/channel.hpp"
#include "smlm/localisation_table.hpp"

namespace polar {

/// What finding sites needs of the rows in the channels that decide the poses.
smlm::LocalisationTable registering_rows(const smlm::LocalisationTable& table,
                                         const smlm::ChannelOptions& channel);

}  // namespace polar
