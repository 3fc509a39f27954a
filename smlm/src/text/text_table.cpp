#include "text_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "../table_builder.hpp"
#include "smlm/error.hpp"

namespace smlm {
namespace {

constexpr std::size_t block_rows = 8192;

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string_view without_quotes(std::string_view text) {
  return text.size() >= 2 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2)
                                                                       : text;
}

bool parse_number(std::string_view text, double& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || text.empty()) return false;
  if (error == std::errc::result_out_of_range) {
    // Too small is zero, too large infinity: the value checks then name it.
    value = text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos ? 0.0
                                                                                                   : HUGE_VAL;
    return true;
  }
  return error == std::errc();
}

// Cuts the next field off `line`; whether a delimiter stood behind it.
bool next_field(std::string_view& line, char delimiter, std::string_view& field) {
  std::size_t search = 0;
  if (!line.empty() && line.front() == '"') search = std::min(line.find('"', 1), line.size());
  const std::size_t end = delimiter == ' ' ? line.find_first_of(" \t", search) : line.find(delimiter, search);
  field = without_quotes(without_blanks(line.substr(0, end)));
  if (end == std::string_view::npos) {
    line = {};
    return false;
  }
  line.remove_prefix(end + 1);
  while (delimiter == ' ' && !line.empty() && (line.front() == ' ' || line.front() == '\t'))
    line.remove_prefix(1);
  return true;
}

std::size_t count_fields(std::string_view line, char delimiter) {
  return split_cells(line, delimiter).size();
}

// What a field that is no number is likely to be, in words that help.
std::string describe(std::string_view field) {
  const std::string shown = field.size() > 40 ? std::string(field.substr(0, 40)) + "..." : std::string(field);
  if (field.empty()) return "the field is empty";
  if (field.find(',') != std::string_view::npos) return "'" + shown + "' has a decimal comma";
  if (field.front() == '+') return "'" + shown + "' has a leading +";
  return "'" + shown + "' is not a number";
}

class RowParser {
 public:
  RowParser(const std::string& path, char delimiter, bool ignore_further_fields, TableBuilder& builder)
      : path_(path),
        delimiter_(delimiter),
        ignore_further_fields_(ignore_further_fields),
        builder_(builder),
        fields_(builder.columns().size()) {
    required_.assign(fields_, false);
    for (const auto& planned : builder.plan().used) {
      if (planned) required_[planned->column] = true;
    }
    if (const auto& particle = builder.plan()[Quantity::particle]) required_[particle->column] = false;
    for (const std::size_t kept : builder.plan().extra) required_[kept] = false;
    block_.columns.resize(fields_);
  }

  void parse(std::string_view line, std::uint64_t number) {
    if (delimiter_ == ' ') line = without_blanks(line);
    const std::string_view whole = line;
    for (std::size_t i = 0; i < fields_; ++i) {
      std::string_view field;
      const bool more = next_field(line, delimiter_, field);
      const bool last = i + 1 == fields_;
      if (last ? more && !ignore_further_fields_ : !more) fail_count(whole, number);
      double value = 0;
      if (builder_.columns()[i].text) {
        value = builder_.label(i, field);
      } else if (!parse_number(field, value)) {
        if (!field.empty() || required_[i]) fail_field(field, number, i);
        value = std::nan("");
      }
      block_.columns[i].push_back(value);
    }
    block_.row.push_back(++rows_);
    block_.line.push_back(number);
    if (block_.row.size() == block_rows) flush();
  }

  void flush() {
    builder_.append(block_);
    for (auto& column : block_.columns) column.clear();
    block_.row.clear();
    block_.line.clear();
  }

 private:
  [[noreturn]] void fail_count(std::string_view line, std::uint64_t number) const {
    throw Error(Fault::input, path_ + ":" + std::to_string(number),
                "has " + std::to_string(count_fields(line, delimiter_)) + " fields where the header has " +
                    std::to_string(fields_),
                "is a line cut, or a decimal written with a comma?");
  }

  [[noreturn]] void fail_field(std::string_view field, std::uint64_t number, std::size_t column) const {
    throw Error(Fault::input, path_ + ":" + std::to_string(number) + ":" + std::to_string(column + 1),
                describe(field) + " (column '" + builder_.columns()[column].name + "')",
                "correct or remove the line");
  }

  const std::string& path_;
  char delimiter_;
  bool ignore_further_fields_;
  TableBuilder& builder_;
  std::size_t fields_;
  std::vector<bool> required_;
  RowBlock block_;
  std::uint64_t rows_ = 0;
};

std::vector<SourceColumn> columns_by_alias(const TextHeader& header) {
  std::vector<SourceColumn> columns;
  for (const std::string& cell : header.cells) columns.push_back({cell, parse_heading(cell).unit});
  return columns;
}

// A column holds words when its first row does.
void mark_text_columns(std::vector<SourceColumn>& columns, std::string_view first_row, char delimiter) {
  const std::vector<std::string> cells = split_cells(first_row, delimiter);
  for (std::size_t i = 0; i < std::min(cells.size(), columns.size()); ++i) {
    double value = 0;
    const auto match = match_heading(parse_heading(columns[i].name));
    const Quantity quantity = columns[i].quantity ? *columns[i].quantity
                              : match             ? match->quantity
                                                  : Quantity::other;
    const bool word = !cells[i].empty() && !parse_number(cells[i], value);
    // Particle names may start as numbers and go on as words.
    columns[i].text =
        columns[i].text || quantity == Quantity::particle || (word && quantity == Quantity::other);
  }
}

}  // namespace

std::vector<SourceColumn> columns_by_role(const std::vector<std::string>& cells,
                                          const std::vector<Role>& roles) {
  std::vector<SourceColumn> columns;
  for (const std::string& cell : cells) {
    const Heading heading = parse_heading(cell);
    SourceColumn column{cell, heading.unit, Quantity::other};
    for (const Role& role : roles) {
      if (role.name != heading.name) continue;
      column.quantity = role.quantity;
      if (column.unit.empty()) column.unit = role.unit;
    }
    columns.push_back(column);
  }
  return columns;
}

std::vector<SourceColumn> nm_columns_by_role(const std::vector<std::string>& cells,
                                             const std::vector<Role>& roles) {
  auto columns = columns_by_role(cells, roles);
  for (SourceColumn& column : columns) {
    if (units::parse_length(column.unit) == units::Length::pixel) column.quantity = Quantity::other;
  }
  return columns;
}

bool header_has(const FileHead& head, const std::vector<std::string_view>& names) {
  if (head.hdf5) return false;
  try {
    const TextHeader header = header_of(head.bytes);
    return std::all_of(names.begin(), names.end(), [&](std::string_view name) {
      return std::any_of(header.cells.begin(), header.cells.end(),
                         [&](const std::string& cell) { return parse_heading(cell).name == name; });
    });
  } catch (const Error&) {
    return false;
  }
}

LocalisationTable read_text_table(const std::string& path, const ReadOptions& options,
                                  const TextFormat& format) {
  LineReader lines(path, format.footer ? Nul::end : Nul::error);
  const TextHeader header = read_header(lines, path);
  ReadOptions effective = options;
  std::vector<SourceColumn> columns =
      format.columns ? format.columns(header, effective) : columns_by_alias(header);

  std::string_view line;
  std::uint64_t number = header.first_row_line;
  bool more = !header.present;
  if (more) {
    line = header.first_row;
  } else {
    while ((more = lines.next(line)) && (without_blanks(line).empty() || line.front() == '#')) {
    }
    number = lines.number();
  }
  if (more) mark_text_columns(columns, line, header.delimiter);
  for (const auto& [key, mapping] : options.columns) {
    for (SourceColumn& column : columns) {
      if (column.name == mapping.name) column.text = key == "particle";
    }
  }

  TableBuilder builder(path, path, columns, effective);
  if (format.reject_infinite_sigma_z) builder.reject_infinite_sigma_z();
  RowParser parser(path, header.delimiter, format.ignore_further_fields, builder);
  for (; more; more = lines.next(line), number = lines.number()) {
    const std::string_view content = without_blanks(line);
    if (content.empty()) {
      if (format.footer) break;
      continue;
    }
    if (content.front() != '#') parser.parse(line, number);
  }
  parser.flush();
  return builder.finish();
}

}  // namespace smlm
