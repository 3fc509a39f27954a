// Numbers as tables of text have them: no locale, the whole field, points or commas.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace smlm {

/// Whether the whole text is a number; too small is zero, too large infinity, so that the value checks name
/// it.
inline bool parse_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return false;
  if (error == std::errc::result_out_of_range) {
    value = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos ? 0.0
                                                                                                   : HUGE_VAL;
    return true;
  }
  return error == std::errc();
}

/// The number that a text with one decimal comma and no point is.
inline std::optional<double> parse_decimal_comma(std::string_view text) {
  const auto comma = text.find(',');
  constexpr std::size_t longest = 64;
  if (comma == std::string_view::npos || text.size() > longest ||
      text.find(',', comma + 1) != std::string_view::npos || text.find('.') != std::string_view::npos)
    return std::nullopt;
  std::string with_point(text);
  with_point[comma] = '.';
  double value = 0;
  return parse_number(with_point, value) ? std::optional(value) : std::nullopt;
}

}  // namespace smlm
