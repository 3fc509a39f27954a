// MINFLUX (abberior) .npy: an array of records. Classic files have one record a localisation with all its
// iterations in itr (the last one is the final); newer ones one record an iteration with `itr` its number and
// `fnl` marking the final one.
#include <algorithm>
#include <fstream>

#include "../npy.hpp"
#include "minflux.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

constexpr std::size_t block_bytes = 4 << 20;

bool recognises(const FileHead& head) { return head.bytes.compare(0, 6, "\x93NUMPY") == 0; }

// Where a field stands in each record: for arrays over iterations, in the last one.
struct Slot {
  const NpyField* field;
  std::size_t offset;
};

Slot final_iteration(const NpyField& field) {
  const bool iterated = field.name.rfind("itr/", 0) == 0 && !field.shape.empty() && field.shape[0] > 0;
  return {&field, iterated ? static_cast<std::size_t>(field.shape[0] - 1) * field.strides[0] : 0};
}

struct Layout {
  const NpyField *location, *trace, *valid, *final;
  std::vector<Slot> extra;
};

Layout layout_of(const std::string& path, const NpyHeader& header) {
  const NpyField* nested = header.field("itr/loc");
  Layout layout{nested != nullptr ? nested : header.field("loc"),
                header.field("tid"),
                header.field("vld"),
                header.field("fnl"),
                {}};
  const std::size_t axes = nested != nullptr ? 2 : 1;
  if (layout.location == nullptr || layout.trace == nullptr || layout.location->shape.size() != axes ||
      (layout.location->shape.back() != 3 && layout.location->shape.back() != 2) ||
      layout.location->count() == 0 || layout.trace->count() != 1) {
    throw Error(Fault::input, path, "is not a MINFLUX table: it has no loc and tid",
                "export the table as CSV with a header");
  }
  for (const NpyField& field : header.fields) {
    const Slot slot = final_iteration(field);
    const std::uint64_t values =
        field.count() / (field.name.rfind("itr/", 0) == 0 && !field.shape.empty() ? field.shape[0] : 1);
    if (&field != layout.trace && &field != layout.location && values == 1) layout.extra.push_back(slot);
  }
  return layout;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
  file.seekg(0);
  std::string beginning(std::min<std::uint64_t>(bytes, 65536), '\0');
  if (!file.read(beginning.data(), static_cast<std::streamsize>(beginning.size()))) {
    throw Error(Fault::io, path, "cannot be read", "check the permissions");
  }
  const NpyHeader header = parse_npy_header(path, beginning);
  if (header.records > (bytes - header.data_offset) / header.record_bytes) {
    throw Error(Fault::input, path, "is truncated: its header promises more records", "copy the file again");
  }
  const Layout layout = layout_of(path, header);
  const Slot location = final_iteration(*layout.location);
  const std::size_t axis_stride = layout.location->strides.back();
  const auto axes = static_cast<std::size_t>(layout.location->shape.back());

  MinfluxRows rows;
  rows.planar = axes == 2;
  for (const Slot& slot : layout.extra) {
    const bool nested = slot.field->name.rfind("itr/", 0) == 0;
    rows.extra.push_back({{nested ? slot.field->name.substr(4) : slot.field->name, "", Quantity::other}, {}});
  }
  file.seekg(static_cast<std::streamoff>(header.data_offset));
  const std::size_t block = std::max<std::size_t>(block_bytes / header.record_bytes, 1);
  std::string buffer(block * header.record_bytes, '\0');
  for (std::uint64_t first = 0; first < header.records; first += block) {
    const std::uint64_t count = std::min<std::uint64_t>(block, header.records - first);
    if (!file.read(buffer.data(), static_cast<std::streamsize>(count * header.record_bytes))) {
      throw Error(Fault::input, path, "is truncated", "copy the file again");
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      const char* record = buffer.data() + i * header.record_bytes;
      if (layout.final != nullptr && npy_value(*layout.final, record, 0) == 0)
        continue;  // an earlier iteration
      if (layout.valid != nullptr && npy_value(*layout.valid, record, 0) == 0) {
        if (rows.invalid++ == 0) rows.first_invalid = first + i + 1;
        continue;
      }
      std::array<double, 3> x{};
      for (std::size_t axis = 0; axis < axes; ++axis) {
        x[axis] = npy_value(*layout.location, record, location.offset + axis * axis_stride);
      }
      rows.location_m.push_back(x);
      rows.trace.push_back(npy_value(*layout.trace, record, 0));
      rows.row.push_back(first + i + 1);
      for (std::size_t e = 0; e < layout.extra.size(); ++e) {
        rows.extra[e].values.push_back(npy_value(*layout.extra[e].field, record, layout.extra[e].offset));
      }
    }
  }
  return build_minflux_table(path, std::move(rows), options);
}

}  // namespace

const TableReader minflux{"minflux", "MINFLUX / Imspector (.npy)", recognises, read};

}  // namespace smlm::readers
