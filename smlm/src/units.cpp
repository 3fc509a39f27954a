#include "smlm/units.hpp"

#include <array>
#include <string>
#include <utility>

namespace smlm::units {

std::optional<Length> parse_length(std::string_view text) {
  std::string lower;
  for (const char c : text) {
    if (c != ' ') lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  using Named = std::pair<std::string_view, Length>;
  static constexpr std::array<Named, 21> known{{
      {"nm", Length::nanometre},
      {"nanometer", Length::nanometre},
      {"nanometre", Length::nanometre},
      {"nanometers", Length::nanometre},
      {"nanometres", Length::nanometre},
      {"um", Length::micrometre},
      {"\xC2\xB5m", Length::micrometre},  // U+00B5 micro sign
      {"\xCE\xBCm", Length::micrometre},  // U+03BC Greek mu
      {"\xB5m", Length::micrometre},      // Latin-1
      {"micron", Length::micrometre},
      {"microns", Length::micrometre},
      {"micrometer", Length::micrometre},
      {"micrometre", Length::micrometre},
      {"mm", Length::millimetre},
      {"m", Length::metre},
      {"meter", Length::metre},
      {"metre", Length::metre},
      {"px", Length::pixel},
      {"pix", Length::pixel},
      {"pixel", Length::pixel},
      {"pixels", Length::pixel},
  }};
  for (const auto& [spelling, unit] : known) {
    if (lower == spelling) return unit;
  }
  return std::nullopt;
}

double to_nm(Length unit, double pixel_size_nm) {
  switch (unit) {
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

std::string_view name(Length unit) {
  switch (unit) {
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
