#include <charconv>
#include <cmath>

#include "fields.hpp"

namespace polar::pipeline {

namespace {
std::string number(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value);
  return {digits, end.ptr};
}

// Plain where that cannot be misread, else in double quotes.
std::string scalar_text(const std::string& value) {
  bool plain = !value.empty() && value != "true" && value != "false" && value != "null";
  for (const char c : value)
    plain = plain && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/' || c == '.' ||
                      (c >= '0' && c <= '9') || c == '-');
  const bool starts_as_word =
      plain && ((value[0] >= 'a' && value[0] <= 'z') || (value[0] >= 'A' && value[0] <= 'Z') ||
                value[0] == '/' || value[0] == '_');
  if (starts_as_word) return value;
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (c == '\n')
      quoted += "\\n";
    else
      quoted += c;
  }
  return quoted + '"';
}

template <class Items, class Format>
std::string joined(const Items& items, Format format) {
  std::string list = "[";
  for (const auto& item : items) list += (list.size() > 1 ? ", " : "") + format(item);
  return list + "]";
}
}  // namespace

void FieldWriter::line(const std::string& content) {
  text_ += std::string(static_cast<std::size_t>(2 * depth_), ' ') + content + "\n";
}

void FieldWriter::field(const char* name, bool value) {
  line(std::string(name) + (value ? ": true" : ": false"));
}
void FieldWriter::field(const char* name, int value) {
  line(std::string(name) + ": " + std::to_string(value));
}
void FieldWriter::field(const char* name, std::int64_t value) {
  line(std::string(name) + ": " + std::to_string(value));
}
void FieldWriter::field(const char* name, std::uint64_t value) {
  line(std::string(name) + ": " + std::to_string(value));
}
void FieldWriter::field(const char* name, double value) { line(std::string(name) + ": " + number(value)); }
void FieldWriter::field(const char* name, const std::string& value) {
  line(std::string(name) + ": " + scalar_text(value));
}
void FieldWriter::field(const char* name, const std::array<double, 2>& range) {
  line(std::string(name) + ": " + joined(range, number));
}
void FieldWriter::field(const char* name, const std::vector<std::string>& list) {
  line(std::string(name) + ": " + joined(list, scalar_text));
}
void FieldWriter::field(const char* name, const std::vector<double>& list) {
  line(std::string(name) + ": " + joined(list, number));
}

void FieldWriter::bounds(const char* name, const std::array<double, 2>& low_high) { field(name, low_high); }
void FieldWriter::bounds(const char* name, const std::map<std::string, std::array<double, 2>>& map) {
  if (map.empty()) return line(std::string(name) + ": {}");
  section(name, [&](FieldWriter& inner) {
    for (const auto& [key, low_high] : map) inner.bounds(scalar_text(key).c_str(), low_high);
  });
}

}  // namespace polar::pipeline
