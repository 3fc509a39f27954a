// The bytes of one input as a file, in memory, under the same name for the whole run.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

inline std::string input_file(const std::uint8_t* data, std::size_t size, const char* extension) {
  static const std::string path = "/dev/shm/polar_fuzz_" + std::to_string(::getpid()) + extension;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(data, 1, size, file) != size) std::abort();
  std::fclose(file);
  return path;
}

inline void require(bool sound) {
  if (!sound) std::abort();
}
