#include "polar/results/render.hpp"
#include "polar/results/results.hpp"
#include "smlm/channel.hpp"

namespace polar {

namespace {
std::vector<bool> rows_of(const smlm::Channels& channels, std::int32_t channel) {
  std::vector<bool> rows(channels.row.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = channels.row[i] == channel;
  return rows;
}
}  // namespace

std::vector<ChannelVolume> render_channels(const smlm::LocalisationTable& table,
                                           const RenderOptions& options) {
  std::vector<ChannelVolume> drawn;
  if (options.channel_column.empty()) return drawn;
  const smlm::Channels channels = smlm::channels_of(table, options.channel_column);
  const Volume box = render(table, options);
  for (std::size_t c = 0; c < channels.names.size(); ++c)
    drawn.push_back(
        {channels.names[c],
         render_into(box, rows_to_draw(table, rows_of(channels, static_cast<std::int32_t>(c))), options)});
  return drawn;
}

}  // namespace polar
