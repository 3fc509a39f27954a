// Writing values: arrays, strings, tables, attributes.
#include <algorithm>
#include <cstring>

#include "handle.hpp"

namespace smlm::h5 {
namespace {

constexpr std::uint64_t target_chunk_bytes = 256 << 10;
// Rows of a table that are interleaved at a time.
constexpr std::uint64_t table_block_rows = 16384;

// Whole rows of the slowest axes, as many as fit the target; the fastest axes stay unbroken.
Shape default_chunk(const Shape& shape, std::size_t element_bytes) {
  Shape chunk = shape;
  std::uint64_t bytes = element_bytes;
  for (std::size_t axis = shape.size(); axis-- > 0;) {
    const std::uint64_t room =
        std::max<std::uint64_t>(target_chunk_bytes / std::max<std::uint64_t>(bytes, 1), 1);
    chunk[axis] = std::max<std::uint64_t>(std::min(shape[axis], room), 1);
    bytes *= chunk[axis];
  }
  return chunk;
}

Handle simple_space(const Shape& shape) {
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  return shape.empty()
             ? Handle(H5Screate(H5S_SCALAR), H5Sclose)
             : Handle(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose);
}

Handle text_type(std::size_t bytes) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), bytes);
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace

void File::State::make_parents(const std::string& object) const {
  const std::string parent = parent_of(object);
  if (resolves(parent)) return;
  make_parents(parent);
  const Handle group(H5Gcreate2(file.get(), parent.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail_io(parent, "the group cannot be created");
}

Handle File::State::create_dataset(const std::string& dataset, hid_t type, hid_t space,
                                   hid_t properties) const {
  make_parents(dataset);
  Handle object(H5Dcreate2(file.get(), dataset.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                H5Dclose);
  if (!object.valid()) fail_io(dataset, "the data set cannot be created");
  return object;
}

void File::write_from(const std::string& dataset, Scalar scalar, const void* data, const Shape& shape,
                      std::uint64_t elements, const Storage& storage) {
  std::uint64_t expected = 1;
  for (const std::uint64_t extent : shape) expected *= extent;
  if (expected != elements) {
    throw Error(Fault::usage, state_->path + ":" + dataset, "its shape and its number of values differ");
  }
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  // No time stamps: the same values give the same bytes.
  H5Pset_obj_track_times(properties.get(), 0);
  if (storage.gzip > 0 && elements > 0) {
    const Shape chunk = storage.chunk.empty() ? default_chunk(shape, size_of(scalar)) : storage.chunk;
    const std::vector<hsize_t> extents(chunk.begin(), chunk.end());
    H5Pset_chunk(properties.get(), static_cast<int>(extents.size()), extents.data());
    H5Pset_shuffle(properties.get());
    H5Pset_deflate(properties.get(), static_cast<unsigned>(storage.gzip));
  }
  const Handle space = simple_space(shape);
  const Handle object = state_->create_dataset(dataset, native_type(scalar), space.get(), properties.get());
  if (elements > 0 && H5Dwrite(object.get(), native_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    state_->fail_io(dataset, "its values cannot be written");
  }
}

void File::write_strings(const std::string& dataset, const std::vector<std::string>& values) {
  std::size_t longest = 1;
  for (const std::string& value : values) longest = std::max(longest, value.size());
  std::string padded;
  for (const std::string& value : values) padded.append(value).append(longest - value.size(), '\0');
  const Handle type = text_type(longest);
  const Handle space = simple_space({values.size()});
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  const Handle object = state_->create_dataset(dataset, type.get(), space.get(), properties.get());
  if (!values.empty() &&
      H5Dwrite(object.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()) < 0) {
    state_->fail_io(dataset, "its text cannot be written");
  }
}

void File::write_table(const std::string& dataset, const std::vector<TableColumn>& columns) {
  std::size_t row_bytes = 0;
  for (const TableColumn& column : columns) row_bytes += size_of(column.scalar);
  const std::uint64_t rows = columns.empty() ? 0 : columns.front().rows;
  if (columns.empty() ||
      std::any_of(columns.begin(), columns.end(), [&](const TableColumn& c) { return c.rows != rows; })) {
    throw Error(Fault::usage, state_->path + ":" + dataset, "its columns are missing or differ in length");
  }
  const Handle type(H5Tcreate(H5T_COMPOUND, row_bytes), H5Tclose);
  std::size_t offset = 0;
  for (const TableColumn& column : columns) {
    H5Tinsert(type.get(), column.name.c_str(), offset, native_type(column.scalar));
    offset += size_of(column.scalar);
  }
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), 0);
  const Handle space = simple_space({rows});
  const Handle object = state_->create_dataset(dataset, type.get(), space.get(), properties.get());

  std::vector<char> block(std::min(rows, table_block_rows) * row_bytes);
  for (std::uint64_t first = 0; first < rows; first += table_block_rows) {
    const std::uint64_t count = std::min(table_block_rows, rows - first);
    offset = 0;
    for (const TableColumn& column : columns) {
      const std::size_t bytes = size_of(column.scalar);
      const char* source = static_cast<const char*>(column.data) + first * bytes;
      for (std::uint64_t row = 0; row < count; ++row) {
        std::memcpy(block.data() + row * row_bytes + offset, source + row * bytes, bytes);
      }
      offset += bytes;
    }
    const hsize_t start = first;
    const hsize_t extent = count;
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &start, nullptr, &extent, nullptr);
    const Handle memory(H5Screate_simple(1, &extent, nullptr), H5Sclose);
    if (H5Dwrite(object.get(), type.get(), memory.get(), space.get(), H5P_DEFAULT, block.data()) < 0) {
      state_->fail_io(dataset, "its rows cannot be written");
    }
  }
}

void File::write_attribute_from(const std::string& object, const std::string& name, Scalar scalar,
                                const void* data, const Shape& shape) {
  const Handle target = state_->open_object(object);
  const Handle space = simple_space(shape);
  const Handle attribute(
      H5Acreate2(target.get(), name.c_str(), native_type(scalar), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.get(), native_type(scalar), data) < 0) {
    state_->fail_io(object + "@" + name, "the attribute cannot be written");
  }
}

void File::write_string_attribute(const std::string& object, const std::string& name,
                                  const std::string& value) {
  const Handle target = state_->open_object(object);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_ASCII);
  const Handle space = simple_space({});
  const Handle attribute(
      H5Acreate2(target.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.get(), type.get(), value.c_str()) < 0) {
    state_->fail_io(object + "@" + name, "the attribute cannot be written");
  }
}

}  // namespace smlm::h5
