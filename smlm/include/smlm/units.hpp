// Lengths are nanometres inside; a factor from here is applied once, at the edge.
#pragma once

#include <optional>
#include <string_view>

namespace smlm::units {

inline constexpr double nm = 1.0;
inline constexpr double um = 1e3;
inline constexpr double mm = 1e6;
inline constexpr double m = 1e9;

/// What a header or a configuration calls a unit of length.
enum class Length { angstrom, nanometre, micrometre, millimetre, metre, pixel };

/// Understands nm, nanometer(s), um, µm (both code points), micron, Å, angstrom, m, px, camera pixels and the
/// like, in any case, but "A" only as a capital; in brackets or bare. Nothing for any other text.
std::optional<Length> parse_length(std::string_view text);

/// The text without a square at its end ("nm^2", "nm²", "nm2" become "nm"); any other text as it is.
std::string_view without_square(std::string_view text);

/// Nanometres per unit; `pixel_size_nm` is used by Length::pixel only.
double to_nm(Length unit, double pixel_size_nm);

/// The unit of so many nanometres; a pixel where none is.
Length length_of(double unit_nm);

/// The short name: nm, um, m, px, angstrom.
std::string_view name(Length unit);

}  // namespace smlm::units
