#include "machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "polar/core/isa.hpp"
#include "polar/core/parallel.hpp"

namespace polar::pipeline {

namespace {
std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.compare(0, 10, "model name") == 0) {
      const std::size_t colon = line.find(": ");
      return colon == std::string::npos ? std::string() : line.substr(colon + 2) + ", ";
    }
  return {};
}

std::string memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES), bytes = ::sysconf(_SC_PAGE_SIZE);
  if (pages <= 0 || bytes <= 0) return {};
  char text[48];
  std::snprintf(text, sizeof text, ", %.1f GB",
                1e-9 * static_cast<double>(pages) * static_cast<double>(bytes));
  return text;
}
}  // namespace

std::string machine_text() {
  const int threads = thread_limit();
  std::string text = processor() + std::to_string(threads) + (threads == 1 ? " thread (" : " threads (") +
                     name(active_isa()) + ")" + memory();
  utsname system{};
  if (::uname(&system) == 0)
    text += std::string(", ") + system.sysname + " " + system.release + " " + system.machine;
  return text;
}

}  // namespace polar::pipeline
