// Numbers as a reader wants them.
#pragma once

#include <cstddef>
#include <string>

namespace polar::report {

/// With so many decimals; "none" where the value is not a number.
std::string fixed(double value, int decimals);

/// With so many significant digits, never in exponential form between 1e-4 and 1e6.
std::string digits(double value, int significant = 3);

/// 0.417 -> "41.7 %".
std::string percent(double share, int decimals = 0);

/// "1 particle", "7 particles".
std::string counted(std::size_t n, const std::string& noun);

/// Bytes that are no UTF-8 are replaced, so that a page is valid whatever a particle is called.
std::string utf8(const std::string& text);

/// "1 m 20 s" from seconds.
std::string duration(double seconds);

}  // namespace polar::report
