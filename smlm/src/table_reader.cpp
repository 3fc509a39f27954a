#include "smlm/table_reader.hpp"

#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <optional>

#include "concatenate.hpp"
#include "mat_v5.hpp"
#include "readers/readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"
#include "smlm/inspect.hpp"
#include "smlm/isolation.hpp"
#include "smlm/number_text.hpp"
#include "smlm/pick.hpp"
#include "smlm/regular_file.hpp"
#include "smlm/repetitions.hpp"

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
  if (head.hdf5 && h5::File::open(head.path).exists("/superparticle")) {
    refuse("is the record of a run, not a table", "write one from it (polar export --to csv) and read that");
  }
  if (head.hdf5 && h5::File::open(head.path).exists("/VTKHDF"))
    refuse("is a VTKHDF file for ParaView, not a table", "read the run's aligned.csv or aligned.hdf5");
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

// Files that hold the same, whatever they are called and however they are packed.
class EqualFiles {
 public:
  void refuse(const FileHead& head) {
    std::vector<File>& alike = files_[std::hash<std::string>()(head.bytes)];
    for (File& other : alike) {
      if (!other.hash) other.hash = content_hash(other.path);
      const std::uint64_t own = content_hash(head.path);
      if (own != *other.hash) continue;
      throw Error(Fault::input, head.path, "holds the same as '" + other.path + "'",
                  "give it once: every localisation would count twice");
    }
    alike.push_back({head.path, {}});
  }

 private:
  struct File {
    std::string path;
    std::optional<std::uint64_t> hash;  // only where another file begins alike
  };
  std::map<std::size_t, std::vector<File>> files_;  // by how they begin
};

// Keys that somebody set and that had no say.
std::vector<std::string> keys_without_effect(const ReadOptions& options, const LocalisationTable& table) {
  const ReadOptions standard;
  struct Key {
    const char* name;
    bool set;
    std::string value, why;
  };
  const Key keys[]{
      {"unit", options.unit != standard.unit, options.unit, "the tables say all their units"},
      {"pixel_size_nm", options.pixel_size_nm != standard.pixel_size_nm, number_text(options.pixel_size_nm),
       "nothing is in pixels"},
      {"sigma_kind", options.sigma_kind != standard.sigma_kind, options.sigma_kind,
       "the tables say what their uncertainties are"},
      {"lpz_unit", options.lpz_unit != standard.lpz_unit, options.lpz_unit, "there is no lpz of Picasso's"},
      {"planar", options.planar, "true", "the tables have no z"},
      {"assumed_sigma_nm", options.assumed_sigma_nm != standard.assumed_sigma_nm,
       number_text(options.assumed_sigma_nm), "the tables have uncertainties"},
      {"minflux_z_factor", options.minflux_z_factor != standard.minflux_z_factor,
       number_text(options.minflux_z_factor), "there is no z of MINFLUX's"},
      {"pick.radius_nm", options.particles != "picked" && options.pick.radius_nm != standard.pick.radius_nm,
       number_text(options.pick.radius_nm), "input.particles is not picked"},
      {"pick.centres", options.particles != "picked" && !options.pick.centres.empty(), options.pick.centres,
       "input.particles is not picked"}};
  std::vector<std::string> warnings;
  for (const Key& key : keys) {
    if (key.set && table.keys_used.count(key.name) == 0)
      warnings.push_back("input." + std::string(key.name) + ": " + key.value + " has no effect: " + key.why);
  }
  for (const std::string& word : options.unassigned_particle) {
    const std::string key = "unassigned_particle: " + word;
    if (table.keys_used.count(key) == 0)
      warnings.push_back("input." + key + " has no effect: no row says so");
  }
  return warnings;
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
  EqualFiles equal;
  for (const std::string& file : files) {
    const FileHead head = read_head(file);
    if (needs_library(head)) {
      require_survival(
          file, [&] { find_reader(head, options).read(file, options); }, reading_limits(file));
    }
    const TableReader& reader = find_reader(head, options);
    LocalisationTable table = reader.read(file, options);
    table.formats.assign(1, std::string(reader.name));
    if (files.size() > 1 && table.size() > 0) equal.refuse(head);
    filter_rows(table, options.filters);
    merge_blinks(table, options.group);
    if (picked) {
      const auto centres = options.pick.centres.empty() ? find_centres(table, options.pick)
                                                        : read_centres(options.pick.centres, options, table);
      pick_particles(table, centres, options.pick.radius_nm);
    }
    all.append(std::move(table));
  }
  LocalisationTable table = all.finish();
  for (auto& more :
       {keys_without_effect(options, table), implausibilities(table), describe(find_repetitions(table))})
    table.warnings.insert(table.warnings.end(), more.begin(), more.end());
  return table;
}

}  // namespace smlm
