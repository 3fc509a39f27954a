#include "polar/results/render.hpp"
#include "smlm/channel.hpp"

namespace polar {

namespace {
// What drawing needs of the rows of one channel.
smlm::LocalisationTable rows_of(const smlm::LocalisationTable& table, const smlm::Channels& channels,
                                std::size_t channel) {
  smlm::LocalisationTable one;
  one.planar = table.planar;
  one.particle_names = table.particle_names;
  for (std::size_t row = 0; row < table.size(); ++row) {
    if (channels.row[row] != static_cast<std::int32_t>(channel)) continue;
    one.position_nm.push_back(table.position_nm[row]);
    one.covariance_nm2.push_back(table.covariance_nm2[row]);
    one.particle.push_back(table.particle[row]);
  }
  return one;
}
}  // namespace

std::vector<ChannelVolume> render_channels(const smlm::LocalisationTable& table,
                                           const RenderOptions& options) {
  std::vector<ChannelVolume> drawn;
  if (options.channel_column.empty()) return drawn;
  const smlm::Channels channels = smlm::channels_of(table, options.channel_column);
  const Volume box = render(table, options);
  for (std::size_t c = 0; c < channels.names.size(); ++c)
    drawn.push_back({channels.names[c], render_into(box, rows_of(table, channels, c), options)});
  return drawn;
}

}  // namespace polar
