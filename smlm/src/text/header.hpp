// The lines before the data of a text table: comments, the header, the delimiter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "line_reader.hpp"

namespace smlm {

struct TextHeader {
  std::vector<std::string> comments;  // without the leading '#'
  std::vector<std::string> cells;     // unquoted; numbers "1", "2", ... where there is no header line
  char delimiter = ',';               // ' ' stands for any run of blanks
  bool present = true;                // false: the first line already holds numbers
  std::string first_row;              // that line
  std::uint64_t first_row_line = 0;
};

/// Reads up to and including the header line. Throws Error(input) when the file ends before it.
TextHeader read_header(LineReader& lines, const std::string& path);

/// The same on the beginning of a file (for recognising formats): a cut last line is ignored.
TextHeader header_of(std::string_view beginning);

/// Splits a line at the delimiter outside quotes; removes quotes (doubled ones stand for one) and blanks.
std::vector<std::string> split_cells(std::string_view line, char delimiter);

}  // namespace smlm
