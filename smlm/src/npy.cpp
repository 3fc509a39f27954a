#include "npy.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr int deepest = 8;
constexpr std::size_t most_fields = 1024;
constexpr std::uint64_t largest_record = 1 << 20;

// Reads the part of Python's literals that NumPy writes.
class HeaderParser {
 public:
  HeaderParser(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  NpyHeader parse() {
    bool has_descr = false, has_order = false, has_shape = false;
    expect('{');
    while (!take('}')) {
      const std::string key = string();
      expect(':');
      if (key == "descr") {
        header_.record_bytes = type("", 0, 0);
        has_descr = true;
      } else if (key == "fortran_order") {
        if (word() != "False") fail("is in Fortran order, which is not read");
        has_order = true;
      } else if (key == "shape") {
        const auto extents = shape();
        if (extents.size() != 1) fail("does not have one dimension");
        header_.records = extents[0];
        has_shape = true;
      } else {
        fail("has the unknown key '" + key + "' in its header");
      }
      take(',');
    }
    if (!has_descr || !has_order || !has_shape) fail("has an incomplete header");
    if (header_.record_bytes == 0) fail("has empty records");
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Fault::input, path_, what, "export it again");
  }

  void skip() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n')) text_.remove_prefix(1);
  }
  bool take(char c) {
    skip();
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!take(c)) fail(std::string("has a malformed header: '") + c + "' is missing");
  }
  bool next_is(char c) {
    skip();
    return !text_.empty() && text_.front() == c;
  }

  std::string string() {
    skip();
    const char quote = text_.empty() ? '\0' : text_.front();
    if (quote != '\'' && quote != '"') fail("has a malformed header: a name is missing");
    const auto end = text_.find(quote, 1);
    if (end == std::string_view::npos) fail("has a malformed header: a name does not end");
    std::string value(text_.substr(1, end - 1));
    text_.remove_prefix(end + 1);
    return value;
  }

  std::string word() {
    skip();
    const auto end = std::min(text_.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"),
                              text_.size());
    std::string value(text_.substr(0, end));
    text_.remove_prefix(end);
    return value;
  }

  std::uint64_t integer() {
    skip();
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) fail("has a malformed header: a number is missing");
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

  std::vector<std::uint64_t> shape() {
    std::vector<std::uint64_t> extents;
    expect('(');
    while (!take(')')) {
      extents.push_back(integer());
      if (extents.size() > deepest) fail("has too many dimensions");
      take(',');
    }
    return extents;
  }

  std::size_t product(const std::vector<std::uint64_t>& extents, std::size_t bytes) const {
    std::uint64_t total = bytes;
    for (const std::uint64_t extent : extents) {
      if (extent > largest_record || total * extent > largest_record) fail("has records that are too large");
      total *= extent;
    }
    return static_cast<std::size_t>(total);
  }

  // A type without its own shape, at `offset` in the record; returns its bytes. The shape follows the type in
  // the text, so fields are added first and get the axes of the arrays around them afterwards.
  std::size_t type(const std::string& name, std::size_t offset, int depth) {
    if (depth > deepest) fail("has a header that is nested too deeply");
    if (!next_is('[')) return scalar(name, offset);
    expect('[');
    std::size_t bytes = 0;
    while (!take(']')) {
      expect('(');
      const std::string member = string();
      expect(',');
      const std::size_t first = header_.fields.size();
      const std::string full = name.empty() ? member : name + "/" + member;
      const std::size_t element = type(full, offset + bytes, depth + 1);
      std::vector<std::uint64_t> extents;
      if (take(',') && next_is('(')) extents = shape();
      expect(')');
      take(',');
      add_shape(first, extents, element);
      bytes += product(extents, element);
      if (bytes > largest_record) fail("has records that are too large");
    }
    return bytes;
  }

  // Puts the axes of an array in front of those of the arrays inside it.
  void add_shape(std::size_t first, const std::vector<std::uint64_t>& extents, std::size_t element) {
    std::size_t stride = product(extents, element);
    for (std::size_t i = 0; i < extents.size(); ++i) {
      stride = extents[i] == 0 ? 0 : stride / static_cast<std::size_t>(extents[i]);
      for (std::size_t f = first; f < header_.fields.size(); ++f) {
        const auto at = static_cast<std::ptrdiff_t>(i);
        header_.fields[f].shape.insert(header_.fields[f].shape.begin() + at, extents[i]);
        header_.fields[f].strides.insert(header_.fields[f].strides.begin() + at, stride);
      }
    }
  }

  std::size_t scalar(const std::string& name, std::size_t offset) {
    const std::string code = string();
    NpyField field;
    field.name = name;
    field.offset = offset;
    const std::string_view orders = "<>|=";
    const bool ordered = !code.empty() && orders.find(code[0]) != std::string_view::npos;
    field.swapped = ordered && code[0] == '>';
    const std::string_view rest = std::string_view(code).substr(ordered ? 1 : 0);
    if (rest.size() < 2) fail("has the unknown type '" + code + "'");
    field.kind = rest[0];
    const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), field.size);
    if (error != std::errc() || end != rest.data() + rest.size() || field.size > largest_record) {
      fail("has the unknown type '" + code + "'");
    }
    if (field.kind == 'O') fail("holds Python objects, which can run code and are never opened");
    if (field.kind == 'U') field.size *= 4;
    if (header_.fields.size() >= most_fields) fail("has too many fields");
    const bool integral = field.kind == 'b' || field.kind == 'i' || field.kind == 'u';
    const bool sized = field.size == 1 || field.size == 2 || field.size == 4 || field.size == 8;
    const bool number =
        (integral && sized) || (field.kind == 'f' && (field.size == 2 || field.size == 4 || field.size == 8));
    if (number) header_.fields.push_back(field);
    return field.size;  // text and padding are stepped over
  }

  const std::string& path_;
  std::string_view text_;
  NpyHeader header_;
};

double half_to_double(std::uint16_t bits) {
  const int exponent = (bits >> 10) & 31;
  const double mantissa = bits & 1023;
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31) return mantissa == 0 ? sign * HUGE_VAL : std::nan("");
  return sign * (exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(mantissa + 1024, exponent - 25));
}

template <class T>
double as(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

std::uint64_t NpyField::count() const {
  std::uint64_t product = 1;
  for (const std::uint64_t extent : shape) product *= extent;
  return product;
}

const NpyField* NpyHeader::field(const std::string& name) const {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [&](const NpyField& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

NpyHeader parse_npy_header(const std::string& path, std::string_view beginning) {
  const auto fail = [&](const std::string& what) {
    throw Error(Fault::input, path, what, "export it again");
  };
  if (beginning.substr(0, 6) != "\x93NUMPY" || beginning.size() < 12) fail("is not a NumPy file");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(beginning[i]));
  };
  const bool long_header = beginning[6] >= 2;
  const std::size_t start = long_header ? 12 : 10;
  std::size_t length = byte(8) | byte(9) << 8;
  if (long_header) length |= byte(10) << 16 | byte(11) << 24;
  if (length > beginning.size() - start) fail("has a NumPy header that is truncated or longer than 64 KiB");
  NpyHeader header = HeaderParser(path, beginning.substr(start, length)).parse();
  header.data_offset = start + length;
  return header;
}

double npy_value(const NpyField& field, const char* record, std::size_t offset) {
  char bytes[8];
  const char* source = record + field.offset + offset;
  if (field.swapped) {
    std::reverse_copy(source, source + field.size, bytes);
  } else {
    std::memcpy(bytes, source, field.size);
  }
  const bool is_signed = field.kind == 'i';
  if (field.kind == 'f') {
    return field.size == 8   ? as<double>(bytes)
           : field.size == 4 ? as<float>(bytes)
                             : half_to_double([&] {
                                 std::uint16_t half;
                                 std::memcpy(&half, bytes, 2);
                                 return half;
                               }());
  }
  switch (field.size) {
    case 1:
      return is_signed ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
    case 2:
      return is_signed ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
    case 4:
      return is_signed ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
    default:
      return is_signed ? as<std::int64_t>(bytes) : as<std::uint64_t>(bytes);
  }
}

}  // namespace smlm
