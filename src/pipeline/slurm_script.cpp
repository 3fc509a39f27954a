#include "slurm_script.hpp"

#include <algorithm>
#include <utility>

#include "config/nearest.hpp"
#include "shell_text.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
constexpr const char *kNames = "names", *kPolar = "polar", *kRestarts = "restarts";

[[noreturn]] void fail(const std::string& from, const std::string& what, const std::string& remedy) {
  throw smlm::Error(smlm::Fault::usage, from, what, remedy);
}

std::string value_of(const std::string& key, const SlurmScript& script, const std::string& from,
                     std::size_t line) {
  if (key == kNames) return shell_words(script.names);
  if (key == kPolar) return shell_words(script.polar);
  if (key == kRestarts) return std::to_string(script.restarts);
  fail(from + ":" + std::to_string(line), "nothing is called {{" + key + "}}",
       "did you mean {{" + nearest_word(key, {kNames, kPolar, kRestarts}) + "}}?");
}
}  // namespace

std::string slurm_script_text(const SlurmScript& script, const std::string& text, const std::string& from) {
  if (text.compare(0, 2, "#!") != 0)
    fail(from + ":1", "the script does not begin with its interpreter", "begin it with #!/bin/bash");
  std::string out;
  std::vector<std::string> asked_for;
  std::size_t at = 0;
  for (std::size_t open; (open = text.find("{{", at)) != std::string::npos;) {
    const std::size_t close = text.find("}}", open);
    const auto line = static_cast<std::size_t>(
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(open), '\n'));
    if (close == std::string::npos || text.find('\n', open) < close)
      fail(from + ":" + std::to_string(line), "{{ is not closed", "write }} after the name");
    asked_for.push_back(text.substr(open + 2, close - open - 2));
    out += text.substr(at, open - at) + value_of(asked_for.back(), script, from, line);
    at = close + 2;
  }
  for (const char* key : {kNames, kPolar})
    if (std::find(asked_for.begin(), asked_for.end(), key) == asked_for.end())
      fail(from, std::string("{{") + key + "}} is missing", "begin with a copy of configs/batch_slurm.sh");
  return out + text.substr(at);
}

}  // namespace polar::pipeline
