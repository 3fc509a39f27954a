// What a data set is, and whether it is safe to read.
#include <algorithm>
#include <limits>

#include "chunk_layout.hpp"
#include "handle.hpp"
#include "stored_type.hpp"

namespace smlm::h5 {
namespace {

// Deflate cannot shrink more than 1032 to 1 (zlib's technical notes); shuffle in front does not change that.
constexpr std::uint64_t max_deflate_ratio = 1032;
// Below this a bomb is harmless, and HDF5's fill values make ratios meaningless.
constexpr std::uint64_t ratio_check_from_bytes = std::uint64_t{64} << 20;

std::uint64_t saturating_product(std::uint64_t a, std::uint64_t b) {
  return b != 0 && a > std::numeric_limits<std::uint64_t>::max() / b
             ? std::numeric_limits<std::uint64_t>::max()
             : a * b;
}

Kind kind_of(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
    case H5T_ENUM:
    case H5T_BITFIELD:
      return Kind::integer;
    case H5T_FLOAT:
      return Kind::real;
    case H5T_STRING:
      return Kind::text;
    case H5T_COMPOUND:
      return Kind::compound;
    case H5T_REFERENCE:
      return Kind::reference;
    default:
      return Kind::other;
  }
}

Member member_of(hid_t compound, unsigned index) {
  Member member;
  char* name = H5Tget_member_name(compound, index);
  if (name != nullptr) {
    member.name = name;
    H5free_memory(name);
  }
  const Handle type(H5Tget_member_type(compound, index), H5Tclose);
  member.kind = kind_of(type.get());
  if (H5Tget_class(type.get()) == H5T_ARRAY) {
    const Handle base(H5Tget_super(type.get()), H5Tclose);
    member.kind = kind_of(base.get());
    const std::size_t size = std::max<std::size_t>(H5Tget_size(base.get()), 1);
    member.elements = H5Tget_size(type.get()) / size;
  }
  return member;
}

bool known_filter(H5Z_filter_t filter) {
  return filter == H5Z_FILTER_DEFLATE || filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_FLETCHER32 ||
         filter == H5Z_FILTER_SZIP || filter == H5Z_FILTER_NBIT || filter == H5Z_FILTER_SCALEOFFSET;
}

void check_filters(const File::State& state, const std::string& dataset, hid_t properties) {
  for (int i = 0; i < H5Pget_nfilters(properties); ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &parameters,
                                               nullptr, 0, nullptr, nullptr);
    if (!known_filter(filter)) {
      state.fail_input(dataset,
                       "is compressed with filter " + std::to_string(filter) + ", which is not built in",
                       "write it again with gzip or without compression");
    }
  }
}

// Text of variable length has another size in the file than in memory.
void check_element_bytes(const File::State& state, const std::string& dataset, hid_t object, hid_t type) {
  if (state.writable || H5Tdetect_class(type, H5T_VLEN) > 0 || H5Tdetect_class(type, H5T_STRING) > 0) return;
  const std::uint64_t stored = chunk_element_bytes(state.path, state.file.get(), object);
  if (stored != 0 && stored != H5Tget_size(type))
    state.fail_input(dataset, "has elements of another size than its type says (damaged?)",
                     "copy the file again");
}

std::uint64_t chunk_bytes(hid_t properties, std::size_t rank, std::uint64_t element_bytes) {
  std::vector<hsize_t> chunk(std::max<std::size_t>(rank, 1));
  if (H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) < 0) return 0;
  std::uint64_t bytes = element_bytes;
  for (const hsize_t extent : chunk) bytes = saturating_product(bytes, extent);
  return bytes;
}

// A chunk of which less is stored than it holds is read beyond its end. Filters make it smaller than that.
void check_chunks(const File::State& state, const std::string& dataset, hid_t object, hid_t properties,
                  std::uint64_t bytes_of_one) {
  if (bytes_of_one > state.limits.max_chunk_bytes)
    throw Error(Fault::resource, state.path + ":" + dataset, "one chunk is larger than will be unpacked",
                "write it with chunks of a few MiB");
  const Handle space(H5Dget_space(object), H5Sclose);
  hsize_t chunks = 0;
  if (state.writable || H5Pget_nfilters(properties) != 0 ||
      H5Dget_num_chunks(object, space.get(), &chunks) < 0)
    return;
  if (H5Dget_storage_size(object) < saturating_product(chunks, bytes_of_one))
    state.fail_input(dataset, "has chunks that are smaller than they claim (damaged?)",
                     "copy the file again");
}

}  // namespace

std::uint64_t DatasetInfo::elements() const {
  std::uint64_t product = 1;
  for (const std::uint64_t extent : shape) product = saturating_product(product, extent);
  return product;
}

const Member* DatasetInfo::member(const std::string& name) const {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.name == name; });
  return found == members.end() ? nullptr : &*found;
}

DatasetInfo File::State::info(const std::string& dataset) const {
  const Handle object = open_object(dataset);
  if (H5Iget_type(object.get()) != H5I_DATASET) fail_input(dataset, "is not a data set");
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  const Handle space(H5Dget_space(object.get()), H5Sclose);
  if (!type.valid() || !space.valid()) fail_input(dataset, "its type or shape cannot be read (damaged?)");
  DatasetInfo info;
  info.kind = kind_of(type.get());
  if (info.kind == Kind::compound) {
    const int members = H5Tget_nmembers(type.get());
    for (int i = 0; i < members; ++i) info.members.push_back(member_of(type.get(), static_cast<unsigned>(i)));
  }
  info.null = H5Sget_simple_extent_type(space.get()) == H5S_NULL;
  if (info.null) {
    info.shape = {0};
    return info;
  }
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) fail_input(dataset, "its shape cannot be read (damaged?)");
  std::vector<hsize_t> extents(static_cast<std::size_t>(std::max(rank, 1)));
  if (rank > 0) H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  info.shape.assign(extents.begin(), extents.begin() + rank);
  return info;
}

DatasetInfo File::info(const std::string& dataset) const { return state_->info(dataset); }

Handle File::State::open_dataset(const std::string& dataset) const {
  Handle object = open_object(dataset);
  if (acceptable.count(dataset) > 0) return object;
  if (H5Iget_type(object.get()) != H5I_DATASET) fail_input(dataset, "is not a data set");
  const Handle properties(H5Dget_create_plist(object.get()), H5Pclose);
  const Handle type(H5Dget_type(object.get()), H5Tclose);
  if (!properties.valid() || !type.valid()) fail_input(dataset, "its properties cannot be read (damaged?)");
  if (!convertible(type.get())) fail_input(dataset, "is of a damaged type", "write or copy the file again");
  if (H5Pget_external_count(properties.get()) > 0) {
    fail_input(dataset, "keeps its values in another file, which is never opened",
               "copy the data into the file");
  }
  const DatasetInfo described = info(dataset);
  const std::uint64_t bytes = saturating_product(described.elements(), H5Tget_size(type.get()));
  switch (H5Pget_layout(properties.get())) {
    case H5D_COMPACT:
      if (bytes > H5Dget_storage_size(object.get()))  // HDF5 1.10 would read beyond its buffer
        fail_input(dataset, "claims more bytes than it stores (damaged?)", "copy the file again");
      break;
    case H5D_CONTIGUOUS:
      if (!writable && bytes > file_bytes && H5Dget_storage_size(object.get()) > 0) {
        fail_input(dataset, "claims more bytes than the file has (truncated?)", "copy the file again");
      }
      break;
    case H5D_CHUNKED:
      check_filters(*this, dataset, properties.get());
      check_element_bytes(*this, dataset, object.get(), type.get());
      check_chunks(*this, dataset, object.get(), properties.get(),
                   chunk_bytes(properties.get(), described.shape.size(), H5Tget_size(type.get())));
      break;
    default:
      fail_input(dataset, "is a virtual data set, whose sources are never opened",
                 "copy the data into the file");
  }
  if (!writable && bytes > ratio_check_from_bytes &&
      bytes / max_deflate_ratio > H5Dget_storage_size(object.get())) {
    fail_input(dataset, "claims " + std::to_string(bytes) + " bytes but stores almost none of them");
  }
  if (!writable) acceptable.insert(dataset);  // counting chunks takes long where there are many
  return object;
}

void File::State::check_bytes(const std::string& dataset, std::uint64_t elements,
                              std::size_t element_bytes) const {
  if (saturating_product(elements, element_bytes) > limits.max_array_bytes) {
    throw Error(Fault::resource, path + ":" + dataset,
                "needs " + std::to_string(elements) + " values at once, more than the limit",
                "split the file");
  }
}

std::uint64_t File::checked_elements(const std::string& dataset, std::size_t element_bytes) const {
  const Handle object = state_->open_dataset(dataset);
  const DatasetInfo described = state_->info(dataset);
  state_->check_bytes(dataset, described.elements(), element_bytes);
  return described.elements();
}

std::uint64_t File::checked_member_elements(const std::string& dataset, const std::string& member,
                                            std::uint64_t first, std::uint64_t rows,
                                            std::size_t element_bytes) const {
  const Handle object = state_->open_dataset(dataset);
  const DatasetInfo described = state_->info(dataset);
  const Member* found = described.member(member);
  if (described.kind != Kind::compound || described.shape.size() != 1 || found == nullptr) {
    state_->fail_input(dataset, "is not a table with a field '" + member + "'");
  }
  if (first > described.shape[0] || rows > described.shape[0] - first) {
    state_->fail_input(dataset, "has fewer than " + std::to_string(first + rows) + " rows");
  }
  const std::uint64_t elements = saturating_product(rows, found->elements);
  state_->check_bytes(dataset, elements, element_bytes);
  return elements;
}

}  // namespace smlm::h5
