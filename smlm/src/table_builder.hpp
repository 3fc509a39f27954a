// Turns blocks of raw columns into a LocalisationTable: units, covariances, checks, rejections, particles.
#pragma once

#include <cstdint>
#include <limits>
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
  /// Makes a kept column one of text, because a row has a word in it: numbers so far become words.
  void make_text(std::size_t column, std::vector<double>& block_values);
  /// Whether a value of the particle column (see label()) stands for no particle.
  bool is_no_particle(double value);
  /// Makes room for about so many rows.
  void reserve(std::uint64_t rows);
  /// Error(resource) where the table would not fit into the machine's memory with this many rows.
  void require_memory_for(std::uint64_t rows) const;
  /// Appends the rows that can be used. A row that cannot is an Error(input) naming file, row and column, or
  /// a counted rejection where options.drop_nonfinite asks for it or the row belongs to no particle. What
  /// only z and its uncertainty lack is judged by finish(), when it is known whether z says anything.
  void append(const RowBlock& block);
  /// Rows that the source itself marks as unusable.
  void reject(const std::string& reason, std::uint64_t row, std::uint64_t rows = 1);
  void warn(const std::string& text) { table_.warnings.push_back(text); }
  /// An infinite sigma_z is this format's way to say "unknown": such rows are rejected, never an error.
  void reject_infinite_sigma_z() { infinite_sigma_z_rejected_ = true; }

  LocalisationTable finish();

 private:
  enum class Reason : std::uint8_t {
    none,
    position_not_finite,
    position_out_of_range,
    sigma_not_finite,
    sigma_not_positive,
    sigma_out_of_range,
    sigma_z_infinite,  // where the format says "unknown" so
    not_positive_definite
  };
  struct Problem {
    Reason reason = Reason::none;
    std::size_t column = 0;
  };
  /// A row that is unusable unless the table turns out to be planar.
  struct Suspended {
    std::uint64_t row;  // of the table
    Reason reason;
  };
  static std::string words(Reason reason, bool of_no_particle);

  Problem lateral_part(const RowBlock& block, std::size_t row, std::array<double, 3>& position,
                       Covariance& covariance) const;
  Problem axial_part(const RowBlock& block, std::size_t row, std::array<double, 3>& position,
                     Covariance& covariance) const;
  Problem sigma(const RowBlock& block, std::size_t row, const PlannedColumn& planned, double& value) const;
  std::string failure(const RowBlock& block, std::size_t row, const Problem& problem) const;
  bool excused(const Problem& problem, std::int64_t particle) const;
  std::int64_t particle_of(const RowBlock& block, std::size_t row);
  std::int64_t particle_of_name(std::string_view name);
  /// Decides whether z says anything; true when the table is planar because it does not.
  bool flatten();
  void drop_suspended();
  void strip_decimals();
  void warn_about_similar_names();

  std::string where_;
  std::vector<SourceColumn> columns_;
  ColumnPlan plan_;
  bool drop_, planar_, positions_only_, infinite_sigma_z_rejected_ = false;
  double assumed_sigma_nm_;
  NameIndex particles_;
  std::vector<std::int64_t> particle_of_label_;  // of the particle column's labels; -1: none
  double last_number_ =
      std::numeric_limits<double>::quiet_NaN();  // rows of one particle mostly follow each other
  std::int64_t last_particle_ = -1;
  NameIndex none_names_;
  std::vector<std::uint64_t> none_rows_;  // how often each was met
  std::vector<NameIndex> labels_;
  std::vector<Suspended> suspended_;
  std::string first_failure_;  // of a suspended row that is not excused
  LocalisationTable table_;
};

}  // namespace smlm
