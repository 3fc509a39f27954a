// Which column of a source becomes which quantity: decided once per file, before its rows are read.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "smlm/column.hpp"
#include "smlm/read_options.hpp"

namespace smlm {

/// A column as the file presents it. A reader that knows its format says what the column is; otherwise the
/// registry of aliases decides.
struct SourceColumn {
  std::string name;
  std::string unit = {};                  // as in the file; empty: unknown
  std::optional<Quantity> quantity = {};  // decided by the reader; `other` keeps it out of the running
  Spread spread = Spread::standard_deviation;
  double unit_nm = 0;  // nm per unit where the reader knows it exactly; 0: `unit` says
  bool text = false;   // holds words, so it can only be a particle name or an extra
};

/// Where a quantity comes from: value_nm = factor * value (factor^2 for variances and covariances).
struct PlannedColumn {
  std::size_t column = 0;
  double factor = 1;
  Spread spread = Spread::standard_deviation;
};

struct ColumnPlan {
  static constexpr std::size_t quantities = static_cast<std::size_t>(Quantity::other);
  std::array<std::optional<PlannedColumn>, quantities> used;
  std::vector<std::size_t> extra;  // columns that are kept
  std::vector<std::string> mapping;
  std::vector<std::string> warnings;
  std::vector<std::string> unassigned_particle;  // beside what always means none
  std::set<std::string> keys_used;               // of the input section

  const std::optional<PlannedColumn>& operator[](Quantity q) const {
    return used[static_cast<std::size_t>(q)];
  }
  /// One per axis, or one lateral value; a covariance has both.
  bool has_uncertainty() const {
    return full_covariance() || (*this)[Quantity::sigma_x] || (*this)[Quantity::sigma_lateral];
  }
  bool has_axial_uncertainty() const {
    return full_covariance() ? (*this)[Quantity::sigma_zz].has_value()
                             : (*this)[Quantity::sigma_z].has_value();
  }
  bool full_covariance() const { return (*this)[Quantity::sigma_xx].has_value(); }
};

/// Throws Error(input) that names `file` for a missing x or y, an ambiguous header (with its candidates), a
/// mapped column that does not exist (with the columns there are), an unknown unit, or pixels of unknown
/// size.
ColumnPlan plan_columns(const std::string& file, const std::vector<SourceColumn>& columns,
                        const ReadOptions& options);

/// The column that `input.columns.<key>` means by `name`: its header, its header without unit, or its 1-based
/// number. Throws Error(input), with the columns there are.
std::size_t find_mapped_column(const std::string& file, const std::vector<SourceColumn>& columns,
                               const std::string& key, const std::string& name);

/// "'x [nm]', 'y [nm]', ..." for messages; at most a dozen.
std::string list_columns(const std::vector<SourceColumn>& columns);

}  // namespace smlm
