// .smlm (ShareLoc, specification 0.2): a ZIP archive with manifest.json and binary tables, row-major, little
// endian. Lengths are nm where the manifest gives no unit; each file's `offset` is added to its columns.
#include <zip.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "../column_arrays.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

using Json = nlohmann::json;
constexpr zip_uint64_t largest_manifest = 16 << 20;
constexpr std::size_t block_rows = 8192;
constexpr std::size_t most_columns = 4096;

struct CloseArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct CloseMember {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, CloseArchive>;
using Member = std::unique_ptr<zip_file_t, CloseMember>;

Archive open_archive(const std::string& path) {
  int code = 0;
  Archive archive(zip_open(path.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &code));
  if (!archive) throw Error(Fault::input, path, "is a damaged ZIP archive", "copy the file again");
  return archive;
}

Member open_member(const std::string& path, zip_t* archive, const std::string& name) {
  Member member(zip_fopen(archive, name.c_str(), 0));
  if (!member)
    throw Error(Fault::input, path + ":" + name, "is not in the archive, or is encrypted", "export it again");
  return member;
}

// Fills `out` or says that the member ended or is damaged.
bool read_fully(zip_file_t* member, char* out, std::size_t bytes) {
  while (bytes > 0) {
    const zip_int64_t read = zip_fread(member, out, bytes);
    if (read <= 0) return false;
    out += read;
    bytes -= static_cast<std::size_t>(read);
  }
  return true;
}

bool recognises(const FileHead& head) {
  if (head.bytes.compare(0, 4, "PK\x03\x04") != 0) return false;
  int code = 0;
  const Archive archive(zip_open(head.path.c_str(), ZIP_RDONLY, &code));
  return archive && zip_name_locate(archive.get(), "manifest.json", 0) >= 0;
}

Json read_manifest(const std::string& path, zip_t* archive) {
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_stat(archive, "manifest.json", 0, &status) != 0 || status.size > largest_manifest) {
    throw Error(Fault::input, path + ":manifest.json", "is missing or larger than 16 MiB", "export it again");
  }
  std::string text(status.size, '\0');
  if (!read_fully(open_member(path, archive, "manifest.json").get(), text.data(), text.size())) {
    throw Error(Fault::input, path + ":manifest.json", "is damaged", "copy the file again");
  }
  Json manifest = Json::parse(text, nullptr, false);
  if (!manifest.is_object())
    throw Error(Fault::input, path + ":manifest.json", "is not a JSON object", "export it again");
  return manifest;
}

// Numbers stand in manifests as numbers or as text.
std::uint64_t integer(const Json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_string()) return 0;
  const std::string& text = value.get_ref<const std::string&>();
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

const Json& entry(const Json& object, const char* key) {
  static const Json none;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

using Convert = double (*)(const char*);

template <class T>
double convert(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

struct Type {
  std::string_view name;
  std::size_t bytes;
  Convert convert;
};
constexpr std::array<Type, 10> types{{{"int8", 1, convert<std::int8_t>},
                                      {"uint8", 1, convert<std::uint8_t>},
                                      {"int16", 2, convert<std::int16_t>},
                                      {"uint16", 2, convert<std::uint16_t>},
                                      {"int32", 4, convert<std::int32_t>},
                                      {"uint32", 4, convert<std::uint32_t>},
                                      {"int64", 8, convert<std::int64_t>},
                                      {"uint64", 8, convert<std::uint64_t>},
                                      {"float32", 4, convert<float>},
                                      {"float64", 8, convert<double>}}};

struct Format {
  std::vector<SourceColumn> columns;
  std::vector<const Type*> type;
  std::vector<std::size_t> offset;
  std::size_t row_bytes = 0;
};

bool is_length(Quantity quantity) { return quantity <= Quantity::sigma_lateral; }

Format parse_format(const std::string& where, const Json& format) {
  const Json& headers = entry(format, "headers");
  const Json& dtypes = entry(format, "dtype");
  const Json& shapes = entry(format, "shape");
  const Json& units = entry(format, "units");
  if (text_of(entry(format, "mode")) != "binary" || !headers.is_array() || !dtypes.is_array() ||
      headers.size() != dtypes.size() || headers.size() > most_columns) {
    throw Error(Fault::input, where, "is not a binary table with headers and dtypes", "export it again");
  }
  Format result;
  for (std::size_t i = 0; i < headers.size(); ++i) {
    const std::string name = text_of(headers[i]);
    const std::string dtype = text_of(dtypes[i]);
    const auto type =
        std::find_if(types.begin(), types.end(), [&](const Type& t) { return t.name == dtype; });
    if (type == types.end())
      throw Error(Fault::input, where, "column '" + name + "' has the unknown type '" + dtype + "'");
    SourceColumn column{name, units.is_array() && i < units.size() ? text_of(units[i]) : ""};
    const auto match = match_heading(parse_heading(name));
    if (column.unit.empty() && match && is_length(match->quantity)) column.unit = "nm";
    const std::uint64_t values = shapes.is_array() && i < shapes.size() ? integer(shapes[i]) : 1;
    if (values != 1)
      throw Error(Fault::input, where, "column '" + name + "' has several values a row, which is not read");
    result.columns.push_back(column);
    result.type.push_back(&*type);
    result.offset.push_back(result.row_bytes);
    result.row_bytes += type->bytes;
  }
  return result;
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  const Archive archive = open_archive(path);
  const Json manifest = read_manifest(path, archive.get());
  const Json* table = nullptr;
  for (const Json& file : entry(manifest, "files")) {
    if (text_of(entry(file, "type")) != "table") continue;
    if (table != nullptr) {
      throw Error(Fault::input, path, "holds more than one table", "export each channel to its own file");
    }
    table = &file;
  }
  if (table == nullptr) throw Error(Fault::input, path, "its manifest lists no table", "export it again");

  const std::string name = text_of(entry(*table, "name"));
  const std::string where = path + ":" + name;
  const Json& offsets = entry(*table, "offset");
  const Format format =
      parse_format(where, entry(entry(manifest, "formats"), text_of(entry(*table, "format")).c_str()));
  const std::uint64_t rows = integer(entry(*table, "rows"));
  TableBuilder builder(path, where, format.columns, options);
  RowBlock block;
  block.columns.resize(format.columns.size());
  const Member member = open_member(path, archive.get(), name);
  std::vector<char> buffer;
  for (std::uint64_t first = 0; first < rows; first += block_rows) {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_rows, rows - first));
    buffer.resize(count * format.row_bytes);
    if (!read_fully(member.get(), buffer.data(), buffer.size())) {
      throw Error(Fault::input, where, "has fewer rows than its manifest says, or is damaged",
                  "copy the file again");
    }
    block.row.resize(count);
    for (std::size_t row = 0; row < count; ++row) block.row[row] = first + row + 1;
    for (std::size_t i = 0; i < format.columns.size(); ++i) {
      const Json& offset = entry(offsets, format.columns[i].name.c_str());
      const double shift = offset.is_number() ? offset.get<double>() : 0.0;
      block.columns[i].resize(count);
      for (std::size_t row = 0; row < count; ++row) {
        block.columns[i][row] =
            format.type[i]->convert(buffer.data() + row * format.row_bytes + format.offset[i]) + shift;
      }
    }
    builder.append(block);
  }
  return builder.finish();
}

}  // namespace

const TableReader smlm_zip{"smlm", "ShareLoc (.smlm)", recognises, read};

}  // namespace smlm::readers
