// Picasso's YAML sidecar on arbitrary bytes.
#include "input_file.hpp"
#include "readers/picasso_sidecar.hpp"
#include "smlm/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto pixel_size_nm = smlm::readers::picasso_pixel_size_nm(input_file(data, size, ".yaml"));
    require(!pixel_size_nm || *pixel_size_nm > 0);
  } catch (const smlm::Error&) {
  }
  return 0;
}
