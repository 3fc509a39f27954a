// The lines before the data of a text table: comments, the header, the delimiter.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "line_reader.hpp"

namespace smlm {

/// A line that was read while looking for the header, and is data.
struct PendingLine {
  std::uint64_t number = 0;
  std::string text;
};

struct TextHeader {
  std::vector<std::string> comments;  // without the leading '#' or '%'
  std::vector<std::string> cells;     // unquoted; numbers "1", "2", ... where there is no header line
  std::string line;                   // the header's, as it stands; empty where there is none
  char delimiter = ',';               // ' ' stands for any run of blanks
  bool present = true;                // false: the first line already holds numbers
  std::vector<PendingLine> pending;   // data that follows, before what the reader gives next
  std::vector<std::string> warnings;  // what stood around the header
};

/// A header is the first line that names x and y, else the first line. Lines before it, a line "sep=;", a
/// comment that names the columns of a table without header, and rows of further names or of units behind it
/// are understood.
///
/// Reads up to and including the header line. Throws Error(input) when the file ends before it.
TextHeader read_header(LineReader& lines, const std::string& path);

/// The same on the beginning of a file (for recognising formats): a cut last line is ignored.
TextHeader header_of(std::string_view beginning);

/// Splits a line at the delimiter outside quotes; removes quotes (doubled ones stand for one) and blanks.
std::vector<std::string> split_cells(std::string_view line, char delimiter);

}  // namespace smlm
