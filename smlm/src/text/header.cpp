#include "header.hpp"

#include <algorithm>
#include <optional>

#include "../missing.hpp"
#include "number.hpp"
#include "smlm/column.hpp"
#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr std::size_t most_columns = 4096;
constexpr std::size_t most_comments = 1000;
constexpr std::size_t most_before_header = 100;
constexpr std::size_t most_rows_of_words = 4;
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

bool is_number(const std::string& cell, char delimiter) {
  double value = 0;
  return parse_number(cell, value) || (delimiter != ',' && parse_decimal_comma(cell));
}

bool is_comment(std::string_view content) { return content.front() == '#' || content.front() == '%'; }

// A line as cells, at the delimiter that makes sense of it.
struct Cells {
  char delimiter = ',';
  std::vector<std::string> cells;

  bool all_numbers() const {
    return is_number(cells.front(), delimiter) &&
           std::all_of(cells.begin(), cells.end(),
                       [&](const std::string& c) { return c.empty() || is_number(c, delimiter); });
  }
  // Neither a number nor nothing at all: names, or units.
  bool all_words() const {
    return std::none_of(cells.begin(), cells.end(),
                        [&](const std::string& c) { return is_number(c, delimiter); }) &&
           std::any_of(cells.begin(), cells.end(), [](const std::string& c) { return !is_missing(c); });
  }
  bool names(Quantity quantity) const {
    return std::any_of(cells.begin(), cells.end(), [&](const std::string& cell) {
      const auto match = match_heading(parse_heading(cell));
      return match && match->quantity == quantity;
    });
  }
  bool names_positions() const { return cells.size() > 1 && names(Quantity::x) && names(Quantity::y); }
};

Cells cells_of(std::string_view line, char delimiter) { return {delimiter, split_cells(line, delimiter)}; }

Cells cells_of(std::string_view line) {
  for (const char delimiter : {'\t', ';'}) {  // decimal commas outnumber what separates them
    Cells found = cells_of(line, delimiter);
    if (found.cells.size() > 1 && found.all_numbers()) return found;
  }
  Cells found = cells_of(line, find_delimiter(line));
  if (found.cells.size() == 1 && line.find('"') != std::string_view::npos) {
    // Some spreadsheets quote the whole line once more.
    const std::string unquoted = found.cells.front();
    found = cells_of(unquoted, find_delimiter(unquoted));
  }
  return found;
}

// "sep=;", which a spreadsheet writes for itself.
std::optional<char> stated_separator(std::string_view content) {
  if (content.size() >= 2 && content.front() == '"' && content.back() == '"')
    content = content.substr(1, content.size() - 2);
  if (content.size() == 5 && (content.substr(0, 4) == "sep=" || content.substr(0, 4) == "SEP="))
    return content[4];
  return std::nullopt;
}

// `next(line)` as LineReader::next; `number()` the line just read.
template <class Next, class Number>
class HeaderParser {
 public:
  HeaderParser(const Next& next, const Number& number, const std::string& path)
      : next_(next), number_(number), path_(path) {}

  TextHeader parse() {
    std::vector<PendingLine> looked;  // lines of content until one names x and y
    std::size_t at = 0;
    bool found = false;
    for (PendingLine line; looked.size() < most_before_header && content_line(line);) {
      looked.push_back(line);
      const Cells cells = separated(line.text);
      if (cells.cells.size() > most_columns) {
        throw Error(Fault::input, path_ + ":" + std::to_string(line.number), "has more than 4096 columns",
                    "is this a table of localisations?");
      }
      found = cells.names_positions();
      at = looked.size() - 1;
      // Data on the first line, or right behind it: there is nothing to look for.
      if (found || (cells.cells.size() > 1 && cells.all_numbers())) break;
    }
    if (looked.empty()) {
      throw Error(Fault::input, path_, "holds no table: it ends before any header",
                  "check that it was written completely");
    }
    if (!found) at = 0;
    if (at > 0) {
      header_.warnings.push_back(std::to_string(at) + (at == 1 ? " line" : " lines") +
                                 " before the header skipped, the first '" +
                                 looked.front().text.substr(0, 40) + "'");
    }
    const Cells cells = separated(looked[at].text);
    header_.delimiter = cells.delimiter;
    header_.cells = cells.cells;
    header_.pending.assign(looked.begin() + static_cast<std::ptrdiff_t>(at + (cells.all_numbers() ? 0 : 1)),
                           looked.end());
    if (cells.all_numbers()) {
      name_columns_of_numbers();
    } else {
      header_.line = looked[at].text;
      take_rows_of_words();
    }
    return std::move(header_);
  }

 private:
  Cells separated(std::string_view line) const {
    return separator_ ? cells_of(line, *separator_) : cells_of(line);
  }

  // The next line that is neither blank nor a comment.
  bool content_line(PendingLine& found) {
    std::string_view line;
    while (next_(line)) {
      if (first_) {
        for (const std::string_view mark : utf16_marks) {
          if (line.substr(0, 2) == mark)
            throw Error(Fault::input, path_, "is UTF-16 text", "save it as UTF-8");
        }
        if (line.substr(0, 3) == byte_order_mark) line.remove_prefix(3);
      }
      const std::string_view content = without_blanks(line);
      const auto separator = first_ ? stated_separator(content) : std::nullopt;
      first_ = false;
      if (content.empty()) continue;
      if (separator) {
        separator_ = *separator == ',' || *separator == ';' || *separator == '\t' ? separator : std::nullopt;
        continue;
      }
      if (is_comment(content)) {
        if (header_.comments.size() < most_comments) header_.comments.emplace_back(content.substr(1));
        continue;
      }
      found = {number_(), std::string(line)};
      return true;
    }
    return false;
  }

  // A comment with as many cells, x and y among them, is the header; else columns are numbered.
  void name_columns_of_numbers() {
    const std::size_t columns = header_.cells.size();
    for (auto comment = header_.comments.rbegin(); comment != header_.comments.rend(); ++comment) {
      for (const Cells& cells : {cells_of(*comment, header_.delimiter), cells_of(*comment)}) {
        if (cells.cells.size() != columns || !cells.names_positions()) continue;
        header_.cells = cells.cells;
        return;
      }
    }
    header_.present = false;
    for (std::size_t i = 0; i < columns; ++i) header_.cells[i] = std::to_string(i + 1);
  }

  // Behind the header: the same names for people, or a row of units.
  void take_rows_of_words() {
    for (std::size_t taken = 0; taken < most_rows_of_words; ++taken) {
      if (header_.pending.empty()) {
        PendingLine line;
        if (!content_line(line)) return;
        header_.pending.push_back(std::move(line));
      }
      const Cells row = cells_of(header_.pending.front().text, header_.delimiter);
      if (row.cells.size() != header_.cells.size() || !row.all_words()) return;
      bool units_row = false;
      for (const std::string& cell : row.cells) units_row = units_row || units::parse_length(cell);
      if (!units_row && row.cells != header_.cells && !row.names_positions()) return;
      header_.warnings.push_back("line " + std::to_string(header_.pending.front().number) +
                                 (units_row ? " gives the units" : " repeats the names") + " of the columns");
      for (std::size_t i = 0; units_row && i < row.cells.size(); ++i) {
        std::string unit = row.cells[i];
        if (unit.size() > 2 && (unit.front() == '(' || unit.front() == '['))
          unit = unit.substr(1, unit.size() - 2);
        if (!unit.empty() && parse_heading(header_.cells[i]).unit.empty())
          header_.cells[i] += " [" + unit + "]";
      }
      header_.pending.erase(header_.pending.begin());
    }
  }

  const Next& next_;
  const Number& number_;
  const std::string& path_;
  TextHeader header_;
  std::optional<char> separator_;
  bool first_ = true;
};

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
  const auto next = [&](std::string_view& line) { return lines.next(line); };
  const auto number = [&] { return lines.number(); };
  return HeaderParser(next, number, path).parse();
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
  const auto line_number = [&] { return number; };
  return HeaderParser(next, line_number, std::string()).parse();
}

}  // namespace smlm
