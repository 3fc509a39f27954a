#include "smlm/channel.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "smlm/error.hpp"
#include "smlm/kept_column.hpp"
#include "smlm/number_text.hpp"

namespace smlm {
namespace {

constexpr std::size_t most_channels = 16;

[[noreturn]] void fail(const std::string& what, const std::string& remedy) {
  throw Error(Fault::input, "input.channel", what, remedy);
}

std::vector<double> distinct_numbers(const ExtraColumn& column) {
  std::set<double> numbers;
  for (const double value : column.values) {
    if (std::isfinite(value)) numbers.insert(value);
    if (numbers.size() > most_channels)
      fail("column '" + column.name + "' holds more than " + std::to_string(most_channels) +
               " different values",
           "name the column that holds the channel");
  }
  return {numbers.begin(), numbers.end()};
}

}  // namespace

std::vector<std::string> violations(const ChannelOptions& options) {
  std::vector<std::string> faults;
  if (!options.column.empty() && options.per_file)
    faults.emplace_back("per_file: leave it false where column names the channel");
  if (options.column.empty() && !options.per_file && !options.registering.empty())
    faults.emplace_back("register: names channels, but neither column nor per_file says what they are");
  return faults;
}

std::string channel_column(const ChannelOptions& options) {
  return options.per_file ? kFileChannel : options.column;
}

Channels channels_of(const LocalisationTable& table, const std::string& name) {
  const ExtraColumn* column = find_named_column(table, name);
  if (column == nullptr) {
    std::string known;
    for (const ExtraColumn& c : table.extra) known += (known.empty() ? "" : ", ") + c.name;
    fail("there is no column '" + name + "'", "the columns are " + known);
  }
  const std::vector<double> values = distinct_numbers(*column);
  Channels channels;
  for (const double value : values)
    channels.names.push_back(column->labels.empty() ? number_text(value)
                                                    : column->labels[static_cast<std::size_t>(value)]);
  channels.row.reserve(column->values.size());
  for (const double value : column->values) {
    const auto found = std::lower_bound(values.begin(), values.end(), value);
    const bool known = std::isfinite(value) && found != values.end();
    channels.row.push_back(known ? static_cast<std::int32_t>(found - values.begin()) : -1);
  }
  return channels;
}

std::vector<bool> registering_channels(const Channels& channels, const ChannelOptions& options) {
  std::vector<bool> registers(channels.names.size(), false);
  if (options.registering.empty() && !registers.empty()) registers.front() = true;
  for (const std::string& name : options.registering) {
    const auto found = std::find(channels.names.begin(), channels.names.end(), name);
    if (found == channels.names.end()) {
      std::string known;
      for (const std::string& n : channels.names) known += (known.empty() ? "" : ", ") + n;
      fail("register names channel '" + name + "', which is not there", "the channels are " + known);
    }
    registers[static_cast<std::size_t>(found - channels.names.begin())] = true;
  }
  return registers;
}

}  // namespace smlm
