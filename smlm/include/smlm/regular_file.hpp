// Input comes from regular files: reading a pipe could wait for ever, reading a device never end.
#pragma once

#include <cstdint>
#include <string>

namespace smlm {

/// Size in bytes. Throws Error(io) where there is no such file or it cannot be seen, Error(input) where it is
/// a folder, a pipe or a device. Does not open it.
std::uint64_t require_regular_file(const std::string& path);

}  // namespace smlm
