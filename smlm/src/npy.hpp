// NumPy's .npy: a header that is a Python literal, then records. Only what tables need: numbers, Booleans,
// nested records and fixed arrays, little or big endian, C order. Objects (pickles) are refused.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace smlm {

/// A number inside a record; nested fields are called "itr/loc". Arrays are flattened: `count` values that
/// lie `stride` bytes apart.
struct NpyField {
  std::string name;
  char kind = 'f';  // b, i, u, f
  std::size_t size = 0;
  std::size_t offset = 0;
  std::vector<std::uint64_t> shape;  // of all enclosing arrays and of the field itself
  std::vector<std::size_t> strides;  // bytes, one per axis of shape
  bool swapped = false;              // stored in the other byte order

  std::uint64_t count() const;
};

struct NpyHeader {
  std::vector<NpyField> fields;  // one without a name where the array holds plain numbers
  std::size_t record_bytes = 0;
  std::uint64_t records = 0;
  std::size_t data_offset = 0;

  const NpyField* field(const std::string& name) const;
};

/// Parses magic and header. Throws Error(input) that names `path`.
NpyHeader parse_npy_header(const std::string& path, std::string_view beginning);

/// One value of a field: `record` points at a record, `offset` is a sum of strides.
double npy_value(const NpyField& field, const char* record, std::size_t offset);

}  // namespace smlm
