#include "checkpoint_file.hpp"

#include <charconv>
#include <cstring>

#include "polar/core/sha256.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
constexpr const char* kFormat = "polar-smlm checkpoint 1";
constexpr std::size_t kDigits = 64;  // of a SHA-256

[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& remedy = {}) {
  throw smlm::Error(smlm::Fault::input, path, what, remedy);
}

void append_sized(std::string& out, const std::string& text) {
  const auto size = static_cast<std::uint64_t>(text.size());
  out.append(reinterpret_cast<const char*>(&size), sizeof size);
  out += text;
}

// Takes the bytes of a file one part after the other.
class Parts {
 public:
  Parts(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  bool at_end() const { return at_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - at_; }

  std::string line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string::npos) fail(path_, "is a truncated checkpoint");
    std::string text = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return text;
  }
  std::string value(const std::string& key) {
    const std::string text = line();
    if (text.compare(0, key.size() + 1, key + " ") != 0) fail(path_, "is a damaged checkpoint");
    return text.substr(key.size() + 1);
  }
  std::uint64_t number(const std::string& key) {
    const std::string text = value(key);
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc() || end != text.data() + text.size()) fail(path_, "is a damaged checkpoint");
    return n;
  }
  std::string sized() {
    std::uint64_t size = 0;
    if (left() < sizeof size) fail(path_, "is a damaged checkpoint");
    std::memcpy(&size, bytes_.data() + at_, sizeof size);
    at_ += sizeof size;
    if (size > left()) fail(path_, "is a damaged checkpoint");
    std::string text = bytes_.substr(at_, size);
    at_ += text.size();
    return text;
  }

 private:
  const std::string& bytes_;
  const std::string& path_;
  std::size_t at_ = 0;
};
}  // namespace

std::string format_checkpoint(const CheckpointContent& content) {
  std::string states;
  for (const auto& [name, bytes] : content.states) append_sized(states, name), append_sized(states, bytes);
  std::string checked = "bytes " + std::to_string(states.size()) + "\n";
  checked += "program " + content.identity.program + "\n";
  checked += "input " + content.identity.input + "\n";
  checked += "configuration " + content.identity.configuration + "\n";
  checked += "instructions " + content.instructions + "\n";
  checked += "number " + std::to_string(content.number) + "\n";
  checked += states;
  return std::string(kFormat) + "\nsha256 " + sha256(checked.data(), checked.size()) + "\n" + checked;
}

CheckpointContent parse_checkpoint(const std::string& bytes, const std::string& path) {
  Parts parts(bytes, path);
  const std::string format = parts.line();
  if (format != kFormat)
    fail(path, "is no checkpoint that this program can read (" + std::string(kFormat) + ")");
  const std::string checksum = parts.value("sha256");
  const std::string checked = bytes.substr(bytes.size() - parts.left());
  const std::uint64_t size = parts.number("bytes");
  CheckpointContent content;
  content.identity.program = parts.value("program");
  content.identity.input = parts.value("input");
  content.identity.configuration = parts.value("configuration");
  content.instructions = parts.value("instructions");
  content.number = parts.number("number");
  if (parts.left() < size) fail(path, "is a truncated checkpoint");
  if (checksum.size() != kDigits || sha256(checked.data(), checked.size()) != checksum)
    fail(path, "is a damaged checkpoint: its checksum differs");
  while (!parts.at_end()) {
    std::string name = parts.sized();
    content.states[std::move(name)] = parts.sized();
  }
  return content;
}

void require_same_computation(const CheckpointContent& content, const ComputationIdentity& identity,
                              const std::string& path) {
  const ComputationIdentity& other = content.identity;
  if (other.input != identity.input)
    fail(path, "belongs to another input: a file has changed since", kComputeAgain);
  if (other.configuration != identity.configuration)
    fail(path, "belongs to another configuration", kComputeAgain);
  if (other.program != identity.program)
    fail(path, "was written by another version: " + other.program + ", this is " + identity.program,
         kComputeAgain);
}

}  // namespace polar::pipeline
