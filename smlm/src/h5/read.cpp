// Reading values: arrays, fields of tables, strings, references, attributes.
#include <algorithm>

#include "handle.hpp"

namespace smlm::h5 {
namespace {

// HDF5 clears a megabyte to convert in, for every call, unless it is told that less will do.
Handle transfer_of(std::uint64_t elements, std::size_t element_bytes) {
  constexpr std::uint64_t least_bytes = 4096, default_bytes = 1 << 20;
  Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  const std::uint64_t most = default_bytes / std::max<std::uint64_t>(1, element_bytes);
  if (elements < most) {
    H5Pset_buffer(transfer.get(), std::max<std::uint64_t>(least_bytes, elements * element_bytes), nullptr,
                  nullptr);
  }
  return transfer;
}

bool numeric(Kind kind) { return kind == Kind::integer || kind == Kind::real; }

std::string until_null(std::string text) {
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

// One string per element of a data set or attribute; `read(memory type, buffer)` is H5Dread or H5Aread.
template <class Read>
std::vector<std::string> read_text(hid_t type, std::uint64_t elements, const Read& read) {
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type) > 0) {
    const Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(memory.get(), H5T_VARIABLE);
    H5Tset_cset(memory.get(), H5Tget_cset(type));
    std::vector<char*> pointers(elements, nullptr);
    read(memory.get(), pointers.data());
    for (char* pointer : pointers) {
      texts.emplace_back(pointer == nullptr ? "" : pointer);
      if (pointer != nullptr) H5free_memory(pointer);
    }
    return texts;
  }
  const std::size_t size = H5Tget_size(type);
  std::string bytes(size * elements, '\0');
  read(type, bytes.data());
  for (std::uint64_t i = 0; i < elements; ++i) texts.push_back(until_null(bytes.substr(i * size, size)));
  return texts;
}

// An open attribute with its type and number of elements.
struct Attribute {
  Handle object, attribute, type;
  std::uint64_t elements = 0;
};

Attribute open_attribute(const File::State& state, const std::string& object, const std::string& name) {
  Attribute found;
  found.object = state.open_object(object);
  const std::string where = object + "@" + name;
  if (H5Aexists(found.object.get(), name.c_str()) <= 0)
    state.fail_input(where, "the attribute does not exist");
  found.attribute = Handle(H5Aopen(found.object.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  found.type = Handle(H5Aget_type(found.attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(found.attribute.get()), H5Sclose);
  const hssize_t elements = H5Sget_simple_extent_npoints(space.get());
  if (!found.type.valid() || elements < 0) state.fail_input(where, "the attribute cannot be read (damaged?)");
  found.elements = static_cast<std::uint64_t>(elements);
  state.check_bytes(where, found.elements, std::max<std::size_t>(H5Tget_size(found.type.get()), 8));
  return found;
}

}  // namespace

hid_t native_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::i8:
      return H5T_NATIVE_INT8;
    case Scalar::u8:
      return H5T_NATIVE_UINT8;
    case Scalar::i16:
      return H5T_NATIVE_INT16;
    case Scalar::u16:
      return H5T_NATIVE_UINT16;
    case Scalar::i32:
      return H5T_NATIVE_INT32;
    case Scalar::u32:
      return H5T_NATIVE_UINT32;
    case Scalar::i64:
      return H5T_NATIVE_INT64;
    case Scalar::u64:
      return H5T_NATIVE_UINT64;
    case Scalar::f32:
      return H5T_NATIVE_FLOAT;
    case Scalar::f64:
      return H5T_NATIVE_DOUBLE;
  }
  return -1;
}

std::size_t size_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::i8:
    case Scalar::u8:
      return 1;
    case Scalar::i16:
    case Scalar::u16:
      return 2;
    case Scalar::i32:
    case Scalar::u32:
    case Scalar::f32:
      return 4;
    default:
      return 8;
  }
}

void File::read_into(const std::string& dataset, Scalar scalar, void* out) const {
  const Handle object = state_->open_dataset(dataset);
  if (!numeric(state_->info(dataset).kind)) state_->fail_input(dataset, "does not hold numbers");
  if (H5Dread(object.get(), native_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, out) < 0) {
    state_->fail_input(dataset, "its values cannot be read (truncated or damaged)", "copy the file again");
  }
}

void File::read_member_into(const std::string& dataset, const std::string& member, Scalar scalar,
                            std::uint64_t first, std::uint64_t rows, void* out) const {
  const DatasetInfo described = state_->info(dataset);
  const Member* field = described.member(member);
  if (field == nullptr || !numeric(field->kind)) {
    state_->fail_input(dataset, "its field '" + member + "' does not hold numbers");
  }
  const hsize_t extent = field->elements;
  const Handle element(
      field->elements == 1 ? H5Tcopy(native_type(scalar)) : H5Tarray_create2(native_type(scalar), 1, &extent),
      H5Tclose);
  read_field(dataset, member, element.get(), first, rows, out);
}

void File::read_field(const std::string& dataset, const std::string& member, std::int64_t element_type,
                      std::uint64_t first, std::uint64_t rows, void* out) const {
  const Handle object = state_->open_dataset(dataset);
  // A memory type with this one field: HDF5 then picks it by name and converts whatever is stored.
  const Handle memory(H5Tcreate(H5T_COMPOUND, H5Tget_size(element_type)), H5Tclose);
  H5Tinsert(memory.get(), member.c_str(), 0, element_type);
  const hsize_t start = first;
  const hsize_t count = rows;
  const Handle stored(H5Dget_space(object.get()), H5Sclose);
  H5Sselect_hyperslab(stored.get(), H5S_SELECT_SET, &start, nullptr, &count, nullptr);
  const Handle wanted(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  const Handle transfer = transfer_of(rows, std::max(H5Tget_size(type.get()), H5Tget_size(memory.get())));
  if (H5Dread(object.get(), memory.get(), wanted.get(), stored.get(), transfer.get(), out) < 0) {
    state_->fail_input(dataset, "its field '" + member + "' cannot be read (truncated or damaged)",
                       "copy the file again");
  }
}

std::vector<std::string> File::read_member_strings(const std::string& dataset, const std::string& member,
                                                   std::uint64_t first, std::uint64_t rows) const {
  const Handle object = state_->open_dataset(dataset);
  const DatasetInfo described = state_->info(dataset);
  const Member* field = described.member(member);
  if (field == nullptr || field->kind != Kind::text || field->elements != 1)
    state_->fail_input(dataset, "its field '" + member + "' does not hold text");
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  const int index = H5Tget_member_index(type.get(), member.c_str());
  const Handle element(H5Tget_member_type(type.get(), static_cast<unsigned>(index)), H5Tclose);
  if (H5Tis_variable_str(element.get()) != 0)
    state_->fail_input(dataset, "its field '" + member + "' holds text of variable length",
                       "write it with a fixed one");
  checked_member_elements(dataset, member, first, rows, H5Tget_size(element.get()));
  return read_text(element.get(), rows,
                   [&](hid_t memory, void* out) { read_field(dataset, member, memory, first, rows, out); });
}

std::vector<std::string> File::read_strings(const std::string& dataset) const {
  const Handle object = state_->open_dataset(dataset);
  const DatasetInfo described = state_->info(dataset);
  if (described.kind != Kind::text) state_->fail_input(dataset, "does not hold text");
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  if (!state_->limits.variable_text && H5Tis_variable_str(type.get()) != 0)
    state_->fail_input(dataset, "holds text of variable length, which is not read here");
  state_->check_bytes(dataset, described.elements(), H5Tget_size(type.get()));
  return read_text(type.get(), described.elements(), [&](hid_t memory, void* out) {
    if (H5Dread(object.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, out) < 0) {
      state_->fail_input(dataset, "its text cannot be read (truncated or damaged)");
    }
  });
}

std::vector<std::string> File::read_references(const std::string& dataset) const {
  const Handle object = state_->open_dataset(dataset);
  const DatasetInfo described = state_->info(dataset);
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  if (H5Tequal(type.get(), H5T_STD_REF_OBJ) <= 0)
    state_->fail_input(dataset, "does not hold object references");
  state_->check_bytes(dataset, described.elements(), sizeof(hobj_ref_t));
  std::vector<hobj_ref_t> references(described.elements());
  if (!references.empty() &&
      H5Dread(object.get(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, references.data()) < 0) {
    state_->fail_input(dataset, "its references cannot be read (truncated or damaged)");
  }
  std::vector<std::string> paths;
  for (const hobj_ref_t& reference : references) {
    const Handle target(H5Rdereference2(object.get(), H5P_DEFAULT, H5R_OBJECT, &reference), H5Oclose);
    const ssize_t length = target.valid() ? H5Iget_name(target.get(), nullptr, 0) : -1;
    if (length <= 0) state_->fail_input(dataset, "holds a reference to nothing");
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    H5Iget_name(target.get(), name.data(), name.size());
    paths.push_back(until_null(name));
  }
  return paths;
}

bool File::has_attribute(const std::string& object, const std::string& name) const {
  return state_->resolves(object) && H5Aexists(state_->open_object(object).get(), name.c_str()) > 0;
}

std::uint64_t File::attribute_elements(const std::string& object, const std::string& name) const {
  return open_attribute(*state_, object, name).elements;
}

void File::read_attribute_into(const std::string& object, const std::string& name, Scalar scalar,
                               void* out) const {
  const Attribute found = open_attribute(*state_, object, name);
  if (found.elements > 0 && H5Aread(found.attribute.get(), native_type(scalar), out) < 0) {
    state_->fail_input(object + "@" + name, "the attribute does not hold numbers");
  }
}

std::string File::read_string_attribute(const std::string& object, const std::string& name) const {
  const Attribute found = open_attribute(*state_, object, name);
  const std::string where = object + "@" + name;
  if (H5Tget_class(found.type.get()) != H5T_STRING || found.elements != 1) {
    state_->fail_input(where, "the attribute is not one text");
  }
  return read_text(found.type.get(), 1,
                   [&](hid_t memory, void* out) {
                     if (H5Aread(found.attribute.get(), memory, out) < 0)
                       state_->fail_input(where, "the attribute cannot be read");
                   })
      .front();
}

}  // namespace smlm::h5
