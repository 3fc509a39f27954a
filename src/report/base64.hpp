// Bytes in a page.
#pragma once

#include <string>

namespace polar::report {

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

/// What the `src` of a picture says.
inline std::string png_uri(const std::string& png) { return "data:image/png;base64," + base64(png); }

}  // namespace polar::report
