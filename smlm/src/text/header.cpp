#include "header.hpp"

#include <algorithm>
#include <charconv>

#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr std::size_t most_columns = 4096;
constexpr std::size_t most_comments = 1000;
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr std::string_view utf16_marks[] = {"\xFF\xFE", "\xFE\xFF"};

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// Any delimiter outside quotes makes a field; the most frequent of them wins, blanks come last.
char find_delimiter(std::string_view line) {
  std::size_t tabs = 0, commas = 0, semicolons = 0;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    tabs += c == '\t';
    commas += c == ',';
    semicolons += c == ';';
  }
  const std::size_t most = std::max({tabs, commas, semicolons});
  if (most == 0) return ' ';
  return most == tabs ? '\t' : most == semicolons ? ';' : ',';
}

bool is_number(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

// `next(line)` as LineReader::next; `number()` the line just read.
template <class Next, class Number>
TextHeader parse_header(const Next& next, const Number& number, const std::string& path) {
  TextHeader header;
  std::string_view line;
  bool first = true;
  while (next(line)) {
    if (first) {
      for (const std::string_view mark : utf16_marks) {
        if (line.substr(0, 2) == mark) throw Error(Fault::input, path, "is UTF-16 text", "save it as UTF-8");
      }
      if (line.substr(0, 3) == byte_order_mark) line.remove_prefix(3);
      first = false;
    }
    const std::string_view content = without_blanks(line);
    if (content.empty()) continue;
    if (content.front() == '#') {
      if (header.comments.size() < most_comments) header.comments.emplace_back(content.substr(1));
      continue;
    }
    header.delimiter = find_delimiter(line);
    header.cells = split_cells(line, header.delimiter);
    if (header.cells.size() == 1 && line.find('"') != std::string_view::npos) {
      // Some spreadsheets quote the whole line once more.
      const std::string unquoted = header.cells.front();
      header.delimiter = find_delimiter(unquoted);
      header.cells = split_cells(unquoted, header.delimiter);
    }
    if (header.cells.size() > most_columns) {
      throw Error(Fault::input, path + ":" + std::to_string(number()), "has more than 4096 columns",
                  "is this a table of localisations?");
    }
    if (is_number(header.cells.front()) &&
        std::all_of(header.cells.begin(), header.cells.end(),
                    [](const std::string& c) { return c.empty() || is_number(c); })) {
      header.present = false;
      header.first_row = std::string(line);
      header.first_row_line = number();
      for (std::size_t i = 0; i < header.cells.size(); ++i) header.cells[i] = std::to_string(i + 1);
    }
    return header;
  }
  throw Error(Fault::input, path, "holds no table: it ends before any header",
              "check that it was written completely");
}

}  // namespace

std::vector<std::string> split_cells(std::string_view line, char delimiter) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  const auto push = [&] {
    cells.emplace_back(without_blanks(cell));
    cell.clear();
  };
  if (delimiter == ' ') line = without_blanks(line);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
        cell += '"';
        ++i;
      } else {
        quoted = !quoted;
      }
    } else if (!quoted && (delimiter == ' ' ? c == ' ' || c == '\t' : c == delimiter)) {
      push();
      while (delimiter == ' ' && i + 1 < line.size() && (line[i + 1] == ' ' || line[i + 1] == '\t')) ++i;
    } else {
      cell += c;
    }
  }
  push();
  return cells;
}

TextHeader read_header(LineReader& lines, const std::string& path) {
  return parse_header([&](std::string_view& line) { return lines.next(line); },
                      [&] { return lines.number(); }, path);
}

TextHeader header_of(std::string_view beginning) {
  const char end = beginning.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::uint64_t number = 0;
  const auto next = [&](std::string_view& line) {
    if (beginning.empty()) return false;
    const auto length = beginning.find(end);
    line = beginning.substr(0, length);
    beginning.remove_prefix(length == std::string_view::npos ? beginning.size() : length + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number;
    return true;
  };
  return parse_header(
      next, [&] { return number; }, "");
}

}  // namespace smlm
