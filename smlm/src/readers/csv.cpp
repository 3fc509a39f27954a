// Any delimited text table: the registry of aliases, or `input.columns`, says which column is what.
#include "../text/text_table.hpp"
#include "readers.hpp"
#include "smlm/error.hpp"

namespace smlm::readers {
namespace {

bool recognises(const FileHead& head) {
  if (head.hdf5 || head.bytes.find('\0') != std::string::npos) return false;
  try {
    const TextHeader header = header_of(head.bytes);
    // "Byte Order: <" is a sidecar and no table.
    const bool yaml = header.delimiter == ' ' && head.bytes.find(": ") < head.bytes.find('\n');
    return header.cells.size() >= 2 && !yaml;
  } catch (const Error&) {
    return false;
  }
}

LocalisationTable read(const std::string& path, const ReadOptions& options) {
  return read_text_table(path, options);
}

}  // namespace

const TableReader csv{"csv", "delimited text with a header (comma, semicolon, tab or blanks)", recognises,
                      read};

}  // namespace smlm::readers
