#include "chunk_layout.hpp"

#include <algorithm>
#include <fstream>
#include <utility>
#include <vector>

#include "handle.hpp"

namespace smlm::h5 {
namespace {

constexpr std::size_t prefix_bytes = 16, message_head_bytes = 8;  // in a header of version 1
constexpr std::uint64_t layout_message = 0x0008, continuation_message = 0x0010, chunked = 2;
constexpr std::uint64_t max_block_bytes = std::uint64_t{1} << 20;
constexpr std::size_t max_blocks = 64;

/// Little-endian; 0 where the bytes end before.
std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  if (at > bytes.size() || size > bytes.size() - at) return 0;
  for (std::size_t k = size; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

std::string block(std::ifstream& in, std::uint64_t position, std::uint64_t size) {
  std::string bytes(static_cast<std::size_t>(std::min(size, max_block_bytes)), '\0');
  in.clear();
  in.seekg(static_cast<std::streamoff>(position));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(in.gcount() > 0 ? static_cast<std::size_t>(in.gcount()) : 0);
  return bytes;
}

std::uint64_t element_bytes(const std::string& layout, std::size_t address_bytes) {
  const bool third = number(layout, 0, 1) == 3;
  if (!third && number(layout, 0, 1) > 2) return 0;
  const std::uint64_t kind = number(layout, third ? 1 : 2, 1), dimensions = number(layout, third ? 2 : 1, 1);
  if (kind != chunked || dimensions == 0) return 0;
  const std::size_t first = (third ? 3 : 8) + address_bytes;  // the element's size is the last dimension
  return number(layout, first + 4 * static_cast<std::size_t>(dimensions - 1), 4);
}

}  // namespace

std::uint64_t chunk_element_bytes(const std::string& path, hid_t file, hid_t dataset) {
  H5O_info_t object;
  hsize_t base = 0;
  std::size_t address_bytes = 0, length_bytes = 0;
  const Handle creation(H5Fget_create_plist(file), H5Pclose);
  if (H5Oget_info(dataset, &object) < 0 || H5Pget_userblock(creation.get(), &base) < 0 ||
      H5Pget_sizes(creation.get(), &address_bytes, &length_bytes) < 0)
    return 0;
  std::ifstream in(path, std::ios::binary);
  const std::string prefix = block(in, base + object.addr, prefix_bytes);
  if (number(prefix, 0, 1) != 1) return 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks = {
      {object.addr + prefix_bytes, number(prefix, 8, 4)}};
  for (std::size_t b = 0; b < std::min(blocks.size(), max_blocks); ++b) {
    const std::string bytes = block(in, base + blocks[b].first, blocks[b].second);
    for (std::size_t at = 0; at + message_head_bytes <= bytes.size();) {
      const std::uint64_t type = number(bytes, at, 2);
      const std::size_t size = static_cast<std::size_t>(number(bytes, at + 2, 2)),
                        data = at + message_head_bytes;
      if (type == layout_message && data < bytes.size())
        return element_bytes(bytes.substr(data, size), address_bytes);
      if (type == continuation_message)
        blocks.emplace_back(number(bytes, data, address_bytes),
                            number(bytes, data + address_bytes, length_bytes));
      at = data + size;
    }
  }
  return 0;
}

}  // namespace smlm::h5
