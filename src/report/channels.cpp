#include "channels.hpp"

#include <map>

#include "polar/results/results.hpp"
#include "smlm/number_text.hpp"

namespace polar::report {

namespace {
constexpr std::size_t kMostChannels = 4;
// In the order of preview.png, a channel in one colour everywhere: green and magenta, which most colour-blind
// readers tell apart, cyan and yellow.
constexpr Tint kTints[kMostChannels] = {{0.2, 1, 0.3}, {1, 0.2, 0.9}, {0.2, 0.9, 1}, {1, 0.9, 0.2}};

const smlm::ExtraColumn* column_named(const smlm::LocalisationTable& table, const std::string& name) {
  for (const smlm::ExtraColumn& c : table.extra)
    if (!name.empty() && c.name == name) return &c;
  return nullptr;
}
}  // namespace

std::vector<Channel> tinted_channels(const smlm::LocalisationTable& table, const std::string& name) {
  const Channel all{"all", "t0", kTints[0], std::vector<bool>(table.size(), true)};
  const smlm::ExtraColumn* column = column_named(table, name);
  if (!column) return {all};
  std::map<double, std::vector<bool>> of;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (!(column->values[i] == column->values[i])) return {all};  // a localisation without a channel
    std::vector<bool>& rows = of[column->values[i]];
    if (of.size() > kMostChannels) return {all};
    rows.resize(table.size());
    rows[i] = true;
  }
  if (of.size() < 2) return {all};
  std::vector<Channel> channels;
  for (auto& [value, rows] : of) {
    const std::size_t c = channels.size();
    const auto label = static_cast<std::size_t>(value);
    const bool named = !column->labels.empty() && value >= 0 && label < column->labels.size();
    channels.push_back({named ? column->labels[label] : "channel " + smlm::number_text(value),
                        "t" + std::to_string(c), kTints[c], std::move(rows)});
  }
  return channels;
}

std::vector<Volume> volumes_of(const smlm::LocalisationTable& table, const std::vector<Channel>& channels,
                               const RenderOptions& options) {
  const Volume whole = render(table, options);
  if (channels.size() == 1) return {whole};
  std::vector<Volume> volumes;
  for (const Channel& channel : channels)
    volumes.push_back(render_into(whole, rows_to_draw(table, channel.rows), options));
  return volumes;
}

}  // namespace polar::report
