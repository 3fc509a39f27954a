#include "polar/results/registering_rows.hpp"

#include "polar/results/results.hpp"

namespace polar {

smlm::LocalisationTable registering_rows(const smlm::LocalisationTable& table,
                                         const smlm::ChannelOptions& channel) {
  const smlm::Channels channels = smlm::channels_of(table, smlm::channel_column(channel));
  const std::vector<bool> registers = smlm::registering_channels(channels, channel);
  std::vector<bool> wanted(table.size());
  for (std::size_t row = 0; row < table.size(); ++row)
    wanted[row] = channels.row[row] >= 0 && registers[static_cast<std::size_t>(channels.row[row])];
  return rows_to_draw(table, wanted);
}

}  // namespace polar
