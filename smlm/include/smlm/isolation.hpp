// Damaged binary files can crash or hang the libraries that read them; this finds out in another process.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace smlm {

/// What reading a file may cost.
struct ReadingLimits {
  unsigned seconds = 0;
  std::uint64_t memory_bytes = 0;  // beyond what the process already has
};

/// Generous for any sound file of this size, on a slow disk and whatever its compression usually is.
ReadingLimits reading_limits(const std::string& path);

/// Runs `attempt` in a forked child whose output is discarded. Returns when the child ends by itself. Throws
/// the smlm::Error that `attempt` threw, so that this process never meets what caused it; and, naming `path`,
/// Error(input) when the child died or took too long, Error(resource) when it took too much memory. Nothing
/// that `attempt` changes is seen here, so the work is done again afterwards, by a process that now knows
/// that it survives it.
void require_survival(const std::string& path, const std::function<void()>& attempt,
                      const ReadingLimits& limits);

/// read() in another process first, then here.
template <class Read>
auto read_isolated(const std::string& path, const Read& read) {
  require_survival(
      path, [&] { read(); }, reading_limits(path));
  return read();
}

}  // namespace smlm
