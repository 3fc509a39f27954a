#include "smlm/units.hpp"

#include <array>
#include <string>
#include <utility>

namespace smlm::units {

std::string_view without_square(std::string_view text) {
  for (const std::string_view square : {"^2", "**2", "\xC2\xB2", "\xB2", "2"}) {
    if (text.size() > square.size() && text.substr(text.size() - square.size()) == square)
      return text.substr(0, text.size() - square.size());
  }
  return text;
}

std::optional<Length> parse_length(std::string_view text) {
  std::string lower;
  for (const char c : text) {
    const bool skipped = c == ' ' || c == '_' || c == '(' || c == ')' || c == '[' || c == ']';
    if (!skipped) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  if (lower == "a") {
    return text.find('A') != std::string_view::npos ? std::optional(Length::angstrom) : std::nullopt;
  }
  using Named = std::pair<std::string_view, Length>;
  static constexpr std::array<Named, 19> known{{
      {"nm", Length::nanometre},
      {"nanometer", Length::nanometre},
      {"nanometre", Length::nanometre},
      {"um", Length::micrometre},
      {"\xC2\xB5m", Length::micrometre},  // U+00B5 micro sign
      {"\xCE\xBCm", Length::micrometre},  // U+03BC Greek mu
      {"\xB5m", Length::micrometre},      // Latin-1
      {"micron", Length::micrometre},
      {"micrometer", Length::micrometre},
      {"micrometre", Length::micrometre},
      {"mm", Length::millimetre},
      {"millimeter", Length::millimetre},
      {"millimetre", Length::millimetre},
      {"m", Length::metre},
      {"meter", Length::metre},
      {"metre", Length::metre},
      {"px", Length::pixel},
      {"pix", Length::pixel},
      {"pixel", Length::pixel},
  }};
  static constexpr std::array<std::string_view, 7> angstroms{
      "angstrom", "\xC3\x85", "\xC3\xA5", "\xE2\x84\xAB", "\xC5", "\xC3\x85ngstrom", "\xC3\xA5ngstrom"};
  std::string_view word = lower;
  if (word.substr(0, 6) == "camera") word.remove_prefix(6);
  if (word.size() > 3 && word.back() == 's') word.remove_suffix(1);
  for (const auto& [spelling, unit] : known) {
    if (word == spelling) return unit;
  }
  for (const std::string_view spelling : angstroms) {
    if (word == spelling) return Length::angstrom;
  }
  return std::nullopt;
}

double to_nm(Length unit, double pixel_size_nm) {
  switch (unit) {
    case Length::angstrom:
      return 0.1 * nm;
    case Length::nanometre:
      return nm;
    case Length::micrometre:
      return um;
    case Length::millimetre:
      return mm;
    case Length::metre:
      return m;
    case Length::pixel:
      return pixel_size_nm;
  }
  return nm;
}

Length length_of(double unit_nm) {
  for (const Length unit :
       {Length::angstrom, Length::nanometre, Length::micrometre, Length::millimetre, Length::metre}) {
    if (unit_nm == to_nm(unit, 0)) return unit;
  }
  return Length::pixel;
}

std::string_view name(Length unit) {
  switch (unit) {
    case Length::angstrom:
      return "angstrom";
    case Length::nanometre:
      return "nm";
    case Length::micrometre:
      return "um";
    case Length::millimetre:
      return "mm";
    case Length::metre:
      return "m";
    case Length::pixel:
      return "px";
  }
  return "nm";
}

}  // namespace smlm::units
