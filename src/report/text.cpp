#include "text.hpp"

#include <cmath>
#include <cstdio>

namespace polar::report {

namespace {
std::string printed(const char* pattern, int precision, double value) {
  char text[400];  // the longest double with a few decimals
  std::snprintf(text, sizeof text, pattern, precision, value);
  return text;
}
}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "none";
  const std::string text = printed("%.*f", decimals, value);
  const bool nothing = text.find_first_not_of("-0.") == std::string::npos;
  return nothing && text[0] == '-' ? text.substr(1) : text;  // no minus zero
}

std::string digits(double value, int significant) {
  if (!std::isfinite(value)) return "none";
  const double size = std::abs(value);
  if (value != 0 && (size < 1e-4 || size >= 1e6)) return printed("%.*g", significant, value);
  const int before = size >= 1 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 0;
  const int after = size >= 1 || value == 0
                        ? significant - before
                        : significant - 1 - static_cast<int>(std::floor(std::log10(size)));
  return fixed(value, value == 0 ? 0 : after > 0 ? after : 0);
}

std::string percent(double share, int decimals) {
  return std::isfinite(share) ? fixed(100 * share, decimals) + " %" : "none";
}

std::string counted(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string utf8(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t length = lead < 0x80       ? 1
                               : lead >> 5 == 6  ? 2
                               : lead >> 4 == 14 ? 3
                               : lead >> 3 == 30 ? 4
                                                 : 0;
    bool valid = length > 0 && i + length <= text.size() && lead != 0xC0 && lead != 0xC1 && lead < 0xF5;
    for (std::size_t k = 1; valid && k < length; ++k)
      valid = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
    if (valid && lead >= 0x20)
      out += text.substr(i, length);
    else if (valid && (lead == '\n' || lead == '\t'))
      out += text[i];
    else
      out += "\xEF\xBF\xBD";  // U+FFFD, for control characters too
    i += valid ? length : 1;
  }
  return out;
}

std::string duration(double seconds) {
  if (!(seconds >= 0)) return "none";
  if (seconds > 0 && seconds < 0.005) return "< 0.01 s";
  if (seconds < 120) return digits(seconds, 3) + " s";
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 7200) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole % 3600 / 60) + " min";
}

}  // namespace polar::report
