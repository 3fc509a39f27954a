// Turns blocks of raw columns into a LocalisationTable: units, covariances, checks, rejections, particles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "column_plan.hpp"
#include "name_index.hpp"
#include "smlm/localisation_table.hpp"

namespace smlm {

/// Some consecutive rows of a source, one vector a column. Columns of text hold indices of
/// TableBuilder::label().
struct RowBlock {
  std::vector<std::vector<double>> columns;
  std::vector<std::uint64_t> row;   // 1-based data row of each, in the source
  std::vector<std::uint64_t> line;  // of a text file, for messages; else empty
};

class TableBuilder {
 public:
  /// `where` prefixes messages: the file, and the object inside it if there is one.
  TableBuilder(std::string file, std::string where, std::vector<SourceColumn> columns,
               const ReadOptions& options);

  const ColumnPlan& plan() const { return plan_; }
  const std::vector<SourceColumn>& columns() const { return columns_; }

  /// The number that stands for a word in a column of text.
  double label(std::size_t column, std::string_view word);
  /// Error(resource) where the table would not fit into the machine's memory with this many rows.
  void require_memory_for(std::uint64_t rows) const;
  /// Appends the rows that can be used. A row that cannot is an Error(input) naming file, row and column, or
  /// a counted rejection where options.drop_nonfinite asks for it.
  void append(const RowBlock& block);
  /// Rows that the source itself marks as unusable.
  void reject(const std::string& reason, std::uint64_t row, std::uint64_t rows = 1);
  void warn(const std::string& text) { table_.warnings.push_back(text); }
  /// An infinite sigma_z is this format's way to say "unknown": such rows are rejected, never an error.
  void reject_infinite_sigma_z() { infinite_sigma_z_rejected_ = true; }

  LocalisationTable finish();

 private:
  struct Problem {
    std::string reason;
    std::size_t column = 0;
  };
  bool convert_row(const RowBlock& block, std::size_t row, std::array<double, 3>& position,
                   Covariance& covariance, Problem& problem) const;
  bool standard_deviations(const RowBlock& block, std::size_t row, Covariance& covariance,
                           Problem& problem) const;
  bool sigma(const RowBlock& block, std::size_t row, const PlannedColumn& planned, double& value,
             Problem& problem) const;
  bool full_covariance(const RowBlock& block, std::size_t row, Covariance& covariance,
                       Problem& problem) const;
  [[noreturn]] void fail(const RowBlock& block, std::size_t row, const Problem& problem) const;
  std::int64_t particle_of(const RowBlock& block, std::size_t row);

  std::string where_;
  std::vector<SourceColumn> columns_;
  ColumnPlan plan_;
  bool drop_, planar_, infinite_sigma_z_rejected_ = false;
  double assumed_sigma_nm_;
  NameIndex particles_;
  std::vector<NameIndex> labels_;
  LocalisationTable table_;
};

}  // namespace smlm
