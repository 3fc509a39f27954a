// poses.csv on arbitrary bytes; whatever is accepted must be written back to the same table.
#include "input_file.hpp"
#include "polar/results/pose_table.hpp"
#include "smlm/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string text = format_pose_table(polar::read_pose_table(input_file(data, size, ".csv")));
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const std::string again = input_file(bytes, text.size(), ".written.csv");
    require(format_pose_table(polar::read_pose_table(again)) == text);
  } catch (const smlm::Error&) {
  }
  return 0;
}
