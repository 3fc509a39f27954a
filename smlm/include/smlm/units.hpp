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
enum class Length { nanometre, micrometre, millimetre, metre, pixel };

/// Understands nm, nanometer, um, µm (both code points), micron, m, px, pix, pixel and the like; the same
/// with ^2 or ² is left to the caller. Nothing for any other text.
std::optional<Length> parse_length(std::string_view text);

/// Nanometres per unit; `pixel_size_nm` is used by Length::pixel only.
double to_nm(Length unit, double pixel_size_nm);

/// The short name: nm, um, m, px.
std::string_view name(Length unit);

}  // namespace smlm::units
