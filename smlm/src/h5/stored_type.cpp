#include "stored_type.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "handle.hpp"

namespace smlm::h5 {
namespace {

constexpr std::size_t bits_per_byte = 8;
constexpr std::size_t largest_number_bytes = 32;  // beyond long double and its paddings

bool number_fits(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  if (size > largest_number_bytes) return false;
  const std::size_t bits = size * bits_per_byte;
  const std::size_t precision = H5Tget_precision(type);
  const int offset = H5Tget_offset(type);
  return precision > 0 && offset >= 0 && static_cast<std::size_t>(offset) <= bits &&
         precision <= bits - static_cast<std::size_t>(offset);
}

bool real_fits(hid_t type) {
  std::size_t sign = 0, exponent = 0, exponent_bits = 0, mantissa = 0, mantissa_bits = 0;
  if (!number_fits(type) ||
      H5Tget_fields(type, &sign, &exponent, &exponent_bits, &mantissa, &mantissa_bits) < 0)
    return false;
  const std::size_t precision = H5Tget_precision(type);
  const auto inside = [&](std::size_t first, std::size_t bits) {
    return bits > 0 && bits <= precision && first <= precision - bits;
  };
  return inside(sign, 1) && inside(exponent, exponent_bits) && inside(mantissa, mantissa_bits) &&
         exponent_bits < bits_per_byte * sizeof(std::uint64_t);
}

bool compound_fits(hid_t type) {
  const std::size_t size = H5Tget_size(type);
  std::vector<std::pair<std::size_t, std::size_t>> fields;  // begin, end
  const int members = H5Tget_nmembers(type);
  for (int i = 0; i < members; ++i) {
    const Handle member(H5Tget_member_type(type, static_cast<unsigned>(i)), H5Tclose);
    const std::size_t begin = H5Tget_member_offset(type, static_cast<unsigned>(i));
    const std::size_t bytes = member.valid() ? H5Tget_size(member.get()) : 0;
    if (bytes == 0 || bytes > size || begin > size - bytes || !convertible(member.get())) return false;
    fields.emplace_back(begin, begin + bytes);
  }
  std::sort(fields.begin(), fields.end());
  const auto overlap = [](const auto& a, const auto& b) { return b.first < a.second; };
  return members > 0 && std::adjacent_find(fields.begin(), fields.end(), overlap) == fields.end();
}

}  // namespace

bool convertible(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
    case H5T_BITFIELD:
      return number_fits(type);
    case H5T_FLOAT:
      return real_fits(type);
    case H5T_COMPOUND:
      return compound_fits(type);
    case H5T_ARRAY:
    case H5T_ENUM:
    case H5T_VLEN: {
      const Handle base(H5Tget_super(type), H5Tclose);
      return base.valid() && convertible(base.get());
    }
    default:
      return H5Tget_size(type) > 0;
  }
}

}  // namespace smlm::h5
