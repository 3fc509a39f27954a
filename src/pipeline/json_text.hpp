// JSON as this program writes it to files.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace polar::pipeline {

/// Indented, with a final newline. Names need not be UTF-8, what JSON holds must: other bytes are replaced.
inline std::string json_text(const nlohmann::json& value) {
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace polar::pipeline
