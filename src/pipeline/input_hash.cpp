#include "input_hash.hpp"

#include <cstdint>
#include <cstdio>
#include <fstream>

#include "polar/core/sha256.hpp"
#include "smlm/error.hpp"
#include "smlm/regular_file.hpp"

namespace polar::pipeline {

namespace {
constexpr std::uint64_t kOffset = 0xcbf29ce484222325, kPrime = 0x100000001b3;

void mix(std::uint64_t& hash, const char* data, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) hash = (hash ^ static_cast<unsigned char>(data[i])) * kPrime;
}

std::string text_of(std::uint64_t hash) {
  char text[32];
  std::snprintf(text, sizeof text, "fnv1a64:%016llx", static_cast<unsigned long long>(hash));
  return text;
}
}  // namespace

InputHash input_hash(const std::vector<std::string>& files, const std::string& configuration) {
  std::uint64_t hash = kOffset;
  std::vector<char> block(1 << 20);
  InputHash named;
  for (const std::string& file : files) {
    smlm::require_regular_file(file);
    std::ifstream in(file, std::ios::binary);
    if (!in) throw smlm::Error(smlm::Fault::io, file, "cannot be opened", "check its permissions");
    std::uint64_t size = 0;
    Sha256 own;
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
      mix(hash, block.data(), static_cast<std::size_t>(in.gcount()));
      own.add(block.data(), static_cast<std::size_t>(in.gcount()));
      size += static_cast<std::uint64_t>(in.gcount());
    }
    const std::string length = ":" + std::to_string(size) + ";";  // so that files cannot run into each other
    mix(hash, length.data(), length.size());
    named.sha256.push_back(own.digits());
  }
  named.files = text_of(hash);
  mix(hash, configuration.data(), configuration.size());
  named.both = text_of(hash);
  hash = kOffset;
  mix(hash, configuration.data(), configuration.size());
  named.configuration = text_of(hash);
  return named;
}

}  // namespace polar::pipeline
