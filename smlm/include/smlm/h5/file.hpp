// The project's only door to HDF5: open or create a file, list it, read and write typed arrays, attributes
// and tables. Objects are named by absolute paths ("/locs", "/VTKHDF/PointData/density").
//
// Files to read are not trusted: no external or soft link, external storage, virtual data set or filter
// plugin is followed, and sizes are checked before memory is taken. Every failure is an smlm::Error that
// names file and object: input for what is wrong inside a file, io for what the system refused, resource
// where a size limit is passed. HDF5 calls are not thread safe: one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace smlm {
class AtomicFile;
}

namespace smlm::h5 {

using Shape = std::vector<std::uint64_t>;  // slowest axis first; empty for a scalar

enum class Scalar { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

/// The Scalar of a C++ arithmetic type.
template <class T>
constexpr Scalar scalar_of() {
  static_assert(std::is_arithmetic_v<T> && !std::is_same_v<T, bool> && sizeof(T) <= 8);
  if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? Scalar::f32 : Scalar::f64;
  } else if constexpr (std::is_signed_v<T>) {
    return sizeof(T) == 1   ? Scalar::i8
           : sizeof(T) == 2 ? Scalar::i16
           : sizeof(T) == 4 ? Scalar::i32
                            : Scalar::i64;
  } else {
    return sizeof(T) == 1   ? Scalar::u8
           : sizeof(T) == 2 ? Scalar::u16
           : sizeof(T) == 4 ? Scalar::u32
                            : Scalar::u64;
  }
}

std::size_t size_of(Scalar scalar);

enum class Kind { integer, real, text, compound, reference, other };

/// One field of a compound data set.
struct Member {
  std::string name;
  Kind kind = Kind::other;
  std::size_t elements = 1;  // > 1 for an array field
};

struct DatasetInfo {
  Kind kind = Kind::other;
  Shape shape;                  // of a null data set: {0}
  bool null = false;            // H5S_NULL, how some programs write "nothing"
  std::vector<Member> members;  // of a compound
  std::uint64_t elements() const;
  const Member* member(const std::string& name) const;  // nullptr when absent
};

struct Entry {
  std::string name;  // without the group's path
  bool is_group = false;
};

/// What reading may cost at most; the defaults suit a workstation.
struct Limits {
  std::uint64_t max_array_bytes = std::uint64_t{32} << 30;
  std::uint64_t max_chunk_bytes = std::uint64_t{1} << 30;
  std::uint64_t max_objects_per_group = 1'000'000;
  /// Whether strings of variable length are read: HDF5 1.10 follows their lengths and places unchecked.
  bool variable_text = true;
};

/// How an array is stored: gzip 0 is contiguous (what Picasso and ParaView read best), 1-9 chunked.
struct Storage {
  int gzip = 0;
  Shape chunk;  // empty: chosen here, about 256 KiB
};

/// A column of a table to write: `data` holds one value a row and is only read during the call.
struct TableColumn {
  std::string name;
  Scalar scalar = Scalar::f64;
  const void* data = nullptr;
  std::uint64_t rows = 0;
};

template <class T>
TableColumn table_column(std::string name, const std::vector<T>& values) {
  return {std::move(name), scalar_of<T>(), values.data(), values.size()};
}

class File {
 public:
  struct State;  // defined beside the implementation

  /// Opens for reading. A file that is locked by another writer is refused with a message that says so.
  static File open(const std::string& path, const Limits& limits = {});
  /// Creates, replacing what `path` held: give it AtomicFile's temporary path.
  static File create(const std::string& path);

  /// The same under the temporary name of a file that appears whole; messages name the final one.
  static File create(const AtomicFile& atomic);
  /// Whether the bytes look like HDF5 (also behind a user block, as MATLAB writes). Never throws.
  static bool is_hdf5(const std::string& path);

  File(File&&) noexcept;
  File& operator=(File&&) noexcept;
  ~File();

  /// Flushes and closes; a writer calls it, because a destructor cannot report that the disk was full.
  void close();
  const std::string& path() const;

  // Reading -----------------------------------------------------------------------------------------
  bool exists(const std::string& object) const;
  bool is_dataset(const std::string& object) const;
  std::vector<Entry> list(const std::string& group) const;
  DatasetInfo info(const std::string& dataset) const;

  /// The whole array, slowest axis first, converted to T.
  template <class T>
  std::vector<T> read(const std::string& dataset) const {
    std::vector<T> values(checked_elements(dataset, sizeof(T)));
    if (!values.empty()) read_into(dataset, scalar_of<T>(), values.data());
    return values;
  }
  /// Rows first .. first + rows - 1 of a one-dimensional compound data set's numeric field.
  template <class T>
  std::vector<T> read_member(const std::string& dataset, const std::string& member, std::uint64_t first,
                             std::uint64_t rows) const {
    std::vector<T> values(checked_member_elements(dataset, member, first, rows, sizeof(T)));
    if (!values.empty()) read_member_into(dataset, member, scalar_of<T>(), first, rows, values.data());
    return values;
  }
  /// The same of a field of text, of fixed length.
  std::vector<std::string> read_member_strings(const std::string& dataset, const std::string& member,
                                               std::uint64_t first, std::uint64_t rows) const;
  /// A data set of strings, of fixed or variable length.
  std::vector<std::string> read_strings(const std::string& dataset) const;
  /// The absolute paths that a data set of object references points at (MATLAB's cell arrays).
  std::vector<std::string> read_references(const std::string& dataset) const;

  bool has_attribute(const std::string& object, const std::string& name) const;
  template <class T>
  std::vector<T> read_attribute(const std::string& object, const std::string& name) const {
    std::vector<T> values(attribute_elements(object, name));
    read_attribute_into(object, name, scalar_of<T>(), values.data());
    return values;
  }
  std::string read_string_attribute(const std::string& object, const std::string& name) const;

  // Writing -----------------------------------------------------------------------------------------
  /// Makes the group and its parents; one that exists is fine.
  void make_group(const std::string& group);
  /// Writes `values` with `shape` (empty: one axis). Parents are made as needed.
  template <class T>
  void write(const std::string& dataset, const std::vector<T>& values, const Shape& shape = {},
             const Storage& storage = {}) {
    write_from(dataset, scalar_of<T>(), values.data(), shape.empty() ? Shape{values.size()} : shape,
               values.size(), storage);
  }
  /// One-dimensional UTF-8, all of the longest one's length, null padded.
  void write_strings(const std::string& dataset, const std::vector<std::string>& values);
  /// A one-dimensional compound data set, one field a column, contiguous (Picasso's /locs). Columns must
  /// have the same number of rows.
  void write_table(const std::string& dataset, const std::vector<TableColumn>& columns);

  /// A one-dimensional attribute, or a scalar one.
  template <class T>
  void write_attribute(const std::string& object, const std::string& name, const std::vector<T>& values) {
    write_attribute_from(object, name, scalar_of<T>(), values.data(), Shape{values.size()});
  }
  template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
  void write_attribute(const std::string& object, const std::string& name, T value) {
    write_attribute_from(object, name, scalar_of<T>(), &value, Shape{});
  }
  /// Scalar, fixed length of exactly value.size() bytes, null padded, ASCII: the only kind of string that
  /// ParaView 5.11 accepts as VTKHDF's Type. An empty value is stored as one null byte.
  void write_string_attribute(const std::string& object, const std::string& name, const std::string& value);

 private:
  explicit File(std::unique_ptr<State> state);

  std::uint64_t checked_elements(const std::string& dataset, std::size_t element_bytes) const;
  std::uint64_t checked_member_elements(const std::string& dataset, const std::string& member,
                                        std::uint64_t first, std::uint64_t rows,
                                        std::size_t element_bytes) const;
  void read_into(const std::string& dataset, Scalar scalar, void* out) const;
  void read_member_into(const std::string& dataset, const std::string& member, Scalar scalar,
                        std::uint64_t first, std::uint64_t rows, void* out) const;
  void read_field(const std::string& dataset, const std::string& member, std::int64_t element_type,
                  std::uint64_t first, std::uint64_t rows, void* out) const;
  std::uint64_t attribute_elements(const std::string& object, const std::string& name) const;
  void read_attribute_into(const std::string& object, const std::string& name, Scalar scalar,
                           void* out) const;
  void write_from(const std::string& dataset, Scalar scalar, const void* data, const Shape& shape,
                  std::uint64_t elements, const Storage& storage);
  void write_attribute_from(const std::string& object, const std::string& name, Scalar scalar,
                            const void* data, const Shape& shape);

  std::unique_ptr<State> state_;
};

}  // namespace smlm::h5
