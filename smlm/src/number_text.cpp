#include "smlm/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace smlm {

std::string number_text(double value) {
  constexpr double exact = 9007199254740992.0;  // 2^53: up to here a double is every whole number
  std::array<char, 32> digits{};
  const bool whole = std::abs(value) <= exact && value == std::trunc(value);
  const auto end =
      whole ? std::to_chars(digits.data(), digits.data() + digits.size(), static_cast<std::int64_t>(value))
            : std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), end.ptr};
}

}  // namespace smlm
