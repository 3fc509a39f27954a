#include "text_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "../missing.hpp"
#include "../table_builder.hpp"
#include "number.hpp"
#include "smlm/error.hpp"
#include "smlm/regular_file.hpp"

namespace smlm {
namespace {

constexpr std::size_t block_rows = 8192;

inline std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

struct Field {
  std::string_view text;  // without quotes and blanks
  bool quoted = false;
  bool doubled = false;  // two quotes inside stand for one
};

// Cuts the next field off `line`; whether a delimiter stood behind it.
bool next_field(std::string_view& line, char delimiter, Field& field) {
  std::size_t search = 0;
  field.doubled = false;
  while (delimiter != ' ' && search < line.size() && line[search] == ' ') ++search;
  if (search < line.size() && line[search] == '"') {
    while (true) {
      search = std::min(line.find('"', search + 1), line.size());
      if (search + 1 >= line.size() || line[search + 1] != '"') break;
      field.doubled = true;
      ++search;
    }
  } else {
    search = 0;
  }
  const std::size_t end = delimiter == ' ' ? line.find_first_of(" \t", search) : line.find(delimiter, search);
  field.text = without_blanks(line.substr(0, end));
  field.quoted = field.text.size() >= 2 && field.text.front() == '"' && field.text.back() == '"';
  if (field.quoted) field.text = field.text.substr(1, field.text.size() - 2);
  if (end == std::string_view::npos) {
    line = {};
    return false;
  }
  line.remove_prefix(end + 1);
  while (delimiter == ' ' && !line.empty() && (line.front() == ' ' || line.front() == '\t'))
    line.remove_prefix(1);
  return true;
}

std::string undoubled(std::string_view text) {
  std::string single;
  for (std::size_t i = 0; i < text.size(); ++i) {
    single += text[i];
    if (text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') ++i;
  }
  return single;
}

std::size_t count_fields(std::string_view line, char delimiter) {
  return split_cells(line, delimiter).size();
}

// What a field that is no number is likely to be, in words that help.
std::string describe(std::string_view field) {
  const std::string shown = field.size() > 40 ? std::string(field.substr(0, 40)) + "..." : std::string(field);
  if (field.find(',') != std::string_view::npos && field.find('.') != std::string_view::npos)
    return "'" + shown + "' has a separator of thousands";
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
    if (const auto& particle = builder.plan()[Quantity::particle]) particle_ = particle->column;
    if (particle_) required_[*particle_] = false;
    for (const std::size_t kept : builder.plan().extra) required_[kept] = false;
    for (const SourceColumn& column : builder.columns()) text_.push_back(column.text ? 1 : 0);
    block_.columns.resize(fields_);
  }

  void parse(std::string_view line, std::uint64_t number) {
    if (delimiter_ == ' ') line = without_blanks(line);
    const std::string_view whole = line;
    bytes_ += line.size() + 1;
    std::optional<std::size_t> bad;
    std::string_view bad_text;
    Field field;
    for (std::size_t i = 0; i < fields_; ++i) {
      const bool more = next_field(line, delimiter_, field);
      const bool last = i + 1 == fields_;
      if (last ? more && !ignore_further_fields_ : !more) fail_count(whole, number);
      double value = 0;
      if (text_[i]) {
        value = label(i, field);
      } else if (parse_number(field.text, value)) {
        fraction_ = fraction_ || std::abs(value - std::trunc(value)) > 0;  // false of nan
      } else if (!other_number(field, value)) {
        if (!required_[i]) {
          text_[i] = true;
          builder_.make_text(i, block_.columns[i]);
          value = label(i, field);
        } else if (!bad) {
          bad = i;
          bad_text = field.text;
        }
      }
      block_.columns[i].push_back(value);
    }
    // What is wrong with a row of no particle is nobody's concern: it is left out and counted.
    if (bad && !(particle_ && builder_.is_no_particle(block_.columns[*particle_].back()))) {
      fail_field(bad_text, number, *bad);
    }
    if (commas_ && fraction_) fail_mixture(number);
    block_.row.push_back(++rows_);
    block_.line.push_back(number);
    if (block_.row.size() == block_rows) flush();
  }

  void flush() {
    // After the first block it is known how long lines are.
    if (rows_ == block_rows) builder_.reserve(static_cast<std::uint64_t>(expected_rows()));
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

  // As many as the file would hold of lines like these; of a compressed file fewer than there are.
  double expected_rows() const {
    const auto bytes = static_cast<double>(require_regular_file(path_));
    constexpr double margin = 1.01;
    return std::max(static_cast<double>(rows_),
                    margin * bytes * static_cast<double>(rows_) / static_cast<double>(bytes_));
  }

  double label(std::size_t column, const Field& field) {
    return field.doubled ? builder_.label(column, undoubled(field.text)) : builder_.label(column, field.text);
  }

  // A number with a decimal comma, where commas cannot be what separates fields, or a word for no number.
  bool other_number(const Field& field, double& value) {
    value = std::nan("");
    if (delimiter_ != ',' || field.quoted) {
      if (const auto comma = parse_decimal_comma(field.text)) {
        commas_ = true;
        value = *comma;
        return true;
      }
    }
    return is_missing(field.text);
  }

  [[noreturn]] void fail_mixture(std::uint64_t number) const {
    throw Error(Fault::input, path_ + ":" + std::to_string(number),
                "decimals are written with points and with commas",
                "write all with points, and no separator of thousands");
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
  std::vector<char> text_;
  std::optional<std::size_t> particle_;
  bool fraction_ = false, commas_ = false;  // a number had a decimal point, a decimal comma
  RowBlock block_;
  std::uint64_t rows_ = 0, bytes_ = 0;
};

// A column holds words when its first row does.
void mark_text_columns(std::vector<SourceColumn>& columns, std::string_view first_row, char delimiter) {
  const std::vector<std::string> cells = split_cells(first_row, delimiter);
  for (std::size_t i = 0; i < std::min(cells.size(), columns.size()); ++i) {
    double value = 0;
    const auto match = match_heading(parse_heading(columns[i].name));
    const Quantity quantity = columns[i].quantity ? *columns[i].quantity
                              : match             ? match->quantity
                                                  : Quantity::other;
    const bool word =
        !is_missing(cells[i]) && !parse_number(cells[i], value) && !parse_decimal_comma(cells[i]);
    // Particle names may start as numbers and go on as words.
    columns[i].text =
        columns[i].text || quantity == Quantity::particle || (word && quantity == Quantity::other);
  }
}

}  // namespace

std::vector<SourceColumn> columns_by_alias(const TextHeader& header) {
  std::vector<SourceColumn> columns;
  for (const std::string& cell : header.cells) columns.push_back({cell, parse_heading(cell).unit});
  return columns;
}

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
  std::size_t taken = 0;  // of the lines that were read in search of the header
  std::uint64_t number = 0;
  const auto next = [&] {
    if (taken < header.pending.size()) {
      line = header.pending[taken].text;
      number = header.pending[taken++].number;
      return true;
    }
    const bool more = lines.next(line);
    number = lines.number();
    return more;
  };
  const auto is_comment = [](std::string_view content) {
    return content.front() == '#' || content.front() == '%';
  };
  bool more = next();
  while (more && (without_blanks(line).empty() || is_comment(without_blanks(line)))) more = next();
  if (more) mark_text_columns(columns, line, header.delimiter);
  for (const auto& [key, mapping] : options.columns) {
    columns[find_mapped_column(path, columns, key, mapping.name)].text = key == "particle";
  }

  TableBuilder builder(path, path, columns, effective);
  if (format.reject_infinite_sigma_z) builder.reject_infinite_sigma_z();
  RowParser parser(path, header.delimiter, format.ignore_further_fields, builder);
  for (const std::string& warning : header.warnings) builder.warn(warning);
  std::uint64_t repeated = 0;
  for (; more; more = next()) {
    const std::string_view content = without_blanks(line);
    if (content.empty()) {
      if (format.footer) break;
      continue;
    }
    if (is_comment(content)) continue;
    if (line.size() == header.line.size() && line == header.line) {
      ++repeated;
    } else {
      parser.parse(line, number);
    }
  }
  parser.flush();
  if (repeated > 0) {
    builder.warn("its header stands in it " + std::to_string(repeated + 1) +
                 " times: was it made of several tables? Equal particle ids are one particle");
  }
  return builder.finish();
}

}  // namespace smlm
