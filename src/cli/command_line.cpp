#include "command_line.hpp"

namespace polar::cli {

namespace {
std::string remembered;

std::string quoted(const std::string& word) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}
}  // namespace

void remember_command(int argc, char** argv) {
  remembered.clear();
  for (int i = 0; i < argc; ++i) remembered += (i > 0 ? " " : "") + quoted(argv[i]);
}

const std::string& command_line() { return remembered; }

}  // namespace polar::cli
