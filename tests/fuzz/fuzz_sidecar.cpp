// Picasso's YAML sidecar on arbitrary bytes.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "readers/picasso_sidecar.hpp"
#include "smlm/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string path = "/dev/shm/polar_fuzz_" + std::to_string(::getpid()) + ".yaml";
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr || std::fwrite(data, 1, size, file) != size) std::abort();
  std::fclose(file);
  try {
    const auto pixel_size_nm = smlm::readers::picasso_pixel_size_nm(path);
    if (pixel_size_nm && !(*pixel_size_nm > 0)) std::abort();
  } catch (const smlm::Error&) {
  }
  return 0;
}
