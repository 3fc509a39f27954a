// The record that an argument `RESULT` stands for.
#pragma once

#include <filesystem>
#include <string>

namespace polar::cli {

/// The results.h5 in a result directory; anything else is taken to be one. Whoever opens it says what is
/// wrong.
inline std::string record_path(const std::string& result) {
  std::error_code unseen;
  return std::filesystem::is_directory(result, unseen) ? result + "/results.h5" : result;
}

}  // namespace polar::cli
