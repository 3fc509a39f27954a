#include "csv_line.hpp"

#include <charconv>
#include <cmath>

#include "smlm/number_text.hpp"

namespace polar::results {

std::vector<std::string> split_csv(const std::string& line, char delimiter) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += c;
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == delimiter && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

std::string csv_field(const std::string& text) {
  std::string clean, doubled;
  for (const char c : text) clean += c == '\n' || c == '\r' ? ' ' : c;
  if (clean.find_first_of(",\"") == std::string::npos) return clean;
  for (const char c : clean) doubled += c == '"' ? "\"\"" : std::string(1, c);
  return '"' + doubled + '"';
}

std::string csv_number(double value) {
  if (std::isnan(value)) return {};
  return smlm::number_text(value + 0.0);  // -0 becomes 0
}

std::string csv_length(double value_nm) {
  constexpr int kDecimals = 4;
  char digits[400];  // a fixed-point double has up to 309 digits before the point
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value_nm, std::chars_format::fixed, kDecimals);
  return {digits, end.ptr};
}

}  // namespace polar::results
