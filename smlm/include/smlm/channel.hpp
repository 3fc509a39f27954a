// Channels: localisations of several colours in the same particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "smlm/localisation_table.hpp"

namespace smlm {

struct ChannelOptions {
  std::string column;                    // that names the channel of a row; empty: one channel
  bool per_file = false;                 // every file is a channel, called by its name without extension
  std::vector<std::string> registering;  // channels that decide the poses; empty: the first
};

/// One sentence per fault, each starting with its key; empty when the options can be used.
std::vector<std::string> violations(const ChannelOptions& options);

/// The kept column that holds the channels where every file is one.
constexpr const char* kFileChannel = "file_channel";

/// The kept column that holds the channels; empty: there is one channel only.
std::string channel_column(const ChannelOptions& options);

struct Channels {
  std::vector<std::string> names;  // numbers ascending, texts in the order of first appearance
  std::vector<std::int32_t> row;   // index into names; -1 where the column says nothing
};

/// The channels in a kept column. Throws Error(input) where there is no such column, or it holds so many
/// different values that it names something else.
Channels channels_of(const LocalisationTable& table, const std::string& column);

/// Which of the channels decide the poses. Throws Error(input), naming the channels, for one that is not
/// there.
std::vector<bool> registering_channels(const Channels& channels, const ChannelOptions& options);

}  // namespace smlm
