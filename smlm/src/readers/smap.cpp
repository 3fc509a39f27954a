// SMAP: *_sml.mat is MATLAB 7.3, which is HDF5, with one (1, N) array per column under /saveloc/loc; the CSV
// exports have the same names. *nm are nm, *pix pixels; locprec* and *err are standard deviations; the
// particle is `sitenumbers` (Analyze > Sitenumbers2loc writes it; the list of sites itself is a MATLAB object
// that nothing else can read), with 0 for "no site".
#include <algorithm>

#include "../column_arrays.hpp"
#include "../text/text_table.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"
#include "smlm/h5/file.hpp"

namespace smlm::readers {
namespace {

constexpr auto loc = "/saveloc/loc";

const std::vector<Role> roles{{"xnm", Quantity::x, "nm"},
                              {"ynm", Quantity::y, "nm"},
                              {"znm", Quantity::z, "nm"},
                              {"xnmerr", Quantity::sigma_x, "nm"},
                              {"ynmerr", Quantity::sigma_y, "nm"},
                              {"locprecnm", Quantity::sigma_lateral, "nm"},
                              {"locprecznm", Quantity::sigma_z, "nm"},
                              {"sitenumbers", Quantity::particle},
                              {"frame", Quantity::frame},
                              {"phot", Quantity::photons},
                              {"bg", Quantity::background}};

bool recognises(const FileHead& head) {
  if (head.hdf5) return h5::File::open(head.path).exists(loc);
  return header_has(head, {"xnm", "ynm"});
}

LocalisationTable read_mat(const std::string& path, const ReadOptions& options) {
  const h5::File file = h5::File::open(path);
  std::vector<std::string> names;
  std::uint64_t rows = 0;
  for (const h5::Entry& entry : file.list(loc)) {
    const std::string object = std::string(loc) + "/" + entry.name;
    if (entry.is_group || !file.is_dataset(object)) continue;
    const h5::DatasetInfo info = file.info(object);
    if (info.kind != h5::Kind::integer && info.kind != h5::Kind::real) continue;
    names.push_back(entry.name);
    if (entry.name == "xnm") rows = info.elements();
  }
  std::vector<ColumnArray> arrays;
  for (const std::string& name : names) {
    const std::string object = std::string(loc) + "/" + name;
    if (file.info(object).elements() != rows) continue;  // settings, not a column
    arrays.push_back({columns_by_role({name}, roles).front(), file.read<double>(object)});
  }
  return build_table(path, path + ":" + loc, std::move(arrays), options);
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  if (h5::File::is_hdf5(path)) return read_mat(path, options);
  TextFormat format;
  format.columns = [](const TextHeader& header, ReadOptions&) {
    return columns_by_role(header.cells, roles);
  };
  return read_text_table(path, options, format);
}

}  // namespace

const TableReader smap{"smap", "SMAP (_sml.mat, .csv)", recognises, read};

}  // namespace smlm::readers
