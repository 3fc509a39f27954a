#include "smlm/table_reader.hpp"

#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "concatenate.hpp"
#include "mat_v5.hpp"
#include "readers/readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/inspect.hpp"
#include "smlm/isolation.hpp"
#include "smlm/pick.hpp"
#include "smlm/regular_file.hpp"

namespace smlm {
namespace {

constexpr std::size_t head_bytes = 65536;

std::string known_formats() {
  std::string names;
  for (const TableReader& reader : table_readers())
    names += (names.empty() ? "" : ", ") + std::string(reader.name);
  return names;
}

// Whether a library with pointers of its own will walk through the file.
bool needs_library(const FileHead& head) {
  return head.hdf5 || is_mat_v5(head.bytes) || head.bytes.compare(0, 4, "PK\x03\x04") == 0;
}

// Formats that are recognised only to say what to do with them.
void refuse_known(const FileHead& head) {
  const auto starts = [&](std::string_view magic) { return head.bytes.compare(0, magic.size(), magic) == 0; };
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw Error(Fault::input, head.path, what, remedy);
  };
  if (head.hdf5 && h5::File::open(head.path).exists("/paraview/dataframe")) {
    refuse("is a pyMINFLUX project", "export the data as .npy from pyMINFLUX");
  }
  if (is_mat_v5(head.bytes))
    refuse("is a MATLAB file without a known table", "save a cell array 'particles', or export CSV");
  if (starts("\xFF\xFE") || starts("\xFE\xFF")) refuse("is UTF-16 text", "save it as UTF-8");
  if (starts("#ASDF")) refuse("is an ASDF file", "export the table as CSV from Locan");
  if (starts("PK\x03\x04")) refuse("is a ZIP archive and not an .smlm file, or damaged", "unpack it first");
  if (head.bytes.find(": ") < head.bytes.find('\n')) {
    refuse("looks like YAML, not a table", "name the .hdf5 file beside it");
  }
  if (starts("\x80\x02") || starts("\x80\x03") || starts("\x80\x04") || starts("\x80\x05")) {
    refuse("is a Python pickle, which can run code and is never opened", "write it as CSV or HDF5");
  }
  if (starts("II*") || starts({"MM\0*", 4})) refuse("is a TIFF image, not a table", "localise it first");
}

}  // namespace

const std::vector<TableReader>& table_readers() {
  static const std::vector<TableReader> all{
      readers::picasso,    readers::picasso_pandas, readers::smap,
      readers::decode,     readers::particle_cells, readers::smlm_zip,
      readers::minflux,    readers::minflux_json,   readers::minflux_mat,
      readers::rapidstorm, readers::elyra,          readers::nstorm,
      readers::oni,        readers::zola,           readers::thunderstorm,
      readers::csv};
  return all;
}

FileHead read_head(const std::string& path) {
  if (require_regular_file(path) == 0)
    throw Error(Fault::input, path, "is empty", "check that it was written completely");
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr)
    throw Error(Fault::io, path, std::strerror(errno), "check the name and the permissions");
  FileHead head;
  head.path = path;
  head.bytes.resize(head_bytes);
  const int read = gzread(file, head.bytes.data(), static_cast<unsigned>(head_bytes));
  head.gzip = gzdirect(file) == 0;
  gzclose(file);
  if (read < 0)
    throw Error(Fault::input, path, "cannot be read, or its gzip stream is damaged", "copy the file again");
  head.bytes.resize(static_cast<std::size_t>(read));
  head.hdf5 = !head.gzip && h5::File::is_hdf5(path);
  return head;
}

const TableReader& find_reader(const FileHead& head, const ReadOptions& options) {
  for (const TableReader& reader : table_readers()) {
    if (options.format == "auto" ? reader.recognises(head) : reader.name == options.format) return reader;
  }
  if (options.format != "auto") {
    throw Error(Fault::usage, "input.format", "'" + options.format + "' is not a format",
                "use auto or one of " + known_formats());
  }
  refuse_known(head);
  throw Error(Fault::input, head.path, "no reader recognises its content",
              "the formats are " + known_formats() + "; for others export a CSV with a header");
}

LocalisationTable read_table(const std::string& file, const ReadOptions& options) {
  return read_tables({file}, options);
}

LocalisationTable read_tables(const std::vector<std::string>& files, const ReadOptions& options) {
  const auto faults = violations(options);
  if (!faults.empty()) throw Error(Fault::usage, "input." + faults.front(), "");
  if (files.empty()) throw Error(Fault::usage, "input.files", "names no file", "name at least one");
  const bool picked = options.particles == "picked";
  if (picked && !options.pick.centres.empty() && files.size() > 1 && !options.channel.per_file) {
    throw Error(Fault::usage, "input.pick.centres", "is one list for several fields of view",
                "read one file at a time");
  }
  Concatenation all(files, options);
  for (const std::string& file : files) {
    const FileHead head = read_head(file);
    if (needs_library(head)) {
      require_survival(
          file, [&] { find_reader(head, options).read(file, options); }, reading_limits(file));
    }
    const TableReader& reader = find_reader(head, options);
    LocalisationTable table = reader.read(file, options);
    table.formats.assign(1, std::string(reader.name));
    filter_rows(table, options.filters);
    merge_blinks(table, options.group);
    if (picked) {
      const auto centres = options.pick.centres.empty() ? find_centres(table, options.pick)
                                                        : read_centres(options.pick.centres);
      pick_particles(table, centres, options.pick.radius_nm);
    }
    all.append(std::move(table));
  }
  LocalisationTable table = all.finish();
  for (std::string& warning : implausibilities(table)) table.warnings.push_back(std::move(warning));
  return table;
}

}  // namespace smlm
