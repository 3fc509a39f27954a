// Readers of localisation tables, chosen by what a file holds and never only by its name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "smlm/localisation_table.hpp"
#include "smlm/read_options.hpp"

namespace smlm {

/// The beginning of a file, for recognising its format.
struct FileHead {
  std::string path;
  std::string bytes;  // the first 64 KiB, after unpacking where the file is gzip-compressed
  bool gzip = false;
  bool hdf5 = false;
};

/// One format. `read` gives a table in nm; planar then means that the file has no z at all.
struct TableReader {
  std::string_view name;         // the value of `input.format`
  std::string_view description;  // the programs that write it
  bool (*recognises)(const FileHead&);
  LocalisationTable (*read)(const std::string& path, const ReadOptions&);
};

/// All readers, the most specific first.
const std::vector<TableReader>& table_readers();

/// Throws Error(io) when the file cannot be opened, Error(input) when it is not a regular file or empty.
FileHead read_head(const std::string& path);

/// The reader for a file: the one that `options.format` names, or the first that recognises the content.
/// Throws Error(input), with what the file seems to be, when none does.
const TableReader& find_reader(const FileHead& head, const ReadOptions& options);

/// Reads all files into one table, in their order. Particles of several files never merge: with more than
/// one file a particle is called "<file name without extension>:<id>", or by the file's name alone where a
/// file is a particle. Columns that only some files have are NaN in the others. A table is planar when no
/// file has a z, or z is constant throughout; a mixture of files with and without z is an error.
LocalisationTable read_tables(const std::vector<std::string>& files, const ReadOptions& options);

/// The same for one file.
LocalisationTable read_table(const std::string& file, const ReadOptions& options);

}  // namespace smlm
