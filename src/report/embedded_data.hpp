// What the page's scripts read: JSON and packed points.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "section.hpp"

namespace polar::report {

/// Safe within a <script>: no "<", and valid whatever a particle is called.
std::string script_json(const nlohmann::json& value);

/// With so many significant digits; null where it is no number.
nlohmann::json rounded_json(double value, int significant);

/// The table of particles: {"heads": [{"name", "number"}], "rows": [[...]]}; `left_out` particles beyond the
/// most that a page takes.
std::string particle_table_json(const RunRecord& record, std::size_t& left_out);

/// The superparticle, thinned evenly: {"n", "half_nm", "points": base64 of int16 x, y, z over half_nm,
/// little-endian, "channel": base64 of bytes, "tints": [[r, g, b]]}. n is 0 where there is nothing to turn.
std::string turntable_json(const Subject& subject);

}  // namespace polar::report
