#include "table_builder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "smlm/error.hpp"

namespace smlm {
namespace {

// A metre: no microscope's coordinate is larger, and squares stay far from the ends of float.
constexpr double largest_nm = 1e9;
constexpr double smallest_sigma_nm = 1e-9;
// What the field's programs assume where the axial precision is not known (Picasso, napari-storm).
constexpr double axial_over_lateral = 2.0;
constexpr double gibibyte = 1024.0 * 1024 * 1024;

double installed_gibibytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / gibibyte;
}

}  // namespace

TableBuilder::TableBuilder(std::string file, std::string where, std::vector<SourceColumn> columns,
                           const ReadOptions& options)
    : where_(std::move(where)),
      columns_(std::move(columns)),
      plan_(plan_columns(where_, columns_, options)),
      drop_(options.drop_nonfinite),
      planar_(!plan_[Quantity::z]),
      assumed_sigma_nm_(options.assumed_sigma_nm),
      labels_(columns_.size()) {
  table_.files.push_back(std::move(file));
  table_.mapping = plan_.mapping;
  table_.warnings = plan_.warnings;
  table_.planar = planar_;
  for (const std::size_t column : plan_.extra) {
    table_.extra.push_back({columns_[column].name, columns_[column].unit, {}, {}});
  }
  if (plan_.full_covariance()) return;
  table_.sigma_assumed = !plan_[Quantity::sigma_x] && !plan_[Quantity::sigma_lateral];
  table_.axial_sigma_assumed = !planar_ && !plan_[Quantity::sigma_z];
  if (table_.sigma_assumed) {
    table_.warnings.push_back("has no uncertainties: " + number_text(assumed_sigma_nm_) +
                              " nm is assumed laterally (input.assumed_sigma_nm)");
  } else if (table_.axial_sigma_assumed) {
    table_.warnings.push_back("has no axial uncertainty: twice the lateral one is assumed");
  }
}

double TableBuilder::label(std::size_t column, std::string_view word) {
  if (word.empty()) return std::nan("");
  return static_cast<double>(labels_[column].of_text(word));
}

bool TableBuilder::sigma(const RowBlock& block, std::size_t row, const PlannedColumn& planned, double& value,
                         Problem& problem) const {
  const double raw = block.columns[planned.column][row];
  value = planned.factor * (planned.spread == Spread::variance && raw > 0 ? std::sqrt(raw) : raw);
  if (value >= smallest_sigma_nm && value <= largest_nm) return true;
  problem = {!std::isfinite(raw) ? "uncertainty is not finite"
             : raw <= 0          ? "uncertainty is not positive"
                                 : "uncertainty is out of range",
             planned.column};
  return false;
}

bool TableBuilder::standard_deviations(const RowBlock& block, std::size_t row, Covariance& covariance,
                                       Problem& problem) const {
  double x = assumed_sigma_nm_;
  double y = assumed_sigma_nm_;
  if (plan_[Quantity::sigma_lateral]) {
    if (!sigma(block, row, *plan_[Quantity::sigma_lateral], x, problem)) return false;
    y = x;
  } else if (plan_[Quantity::sigma_x]) {
    if (!sigma(block, row, *plan_[Quantity::sigma_x], x, problem)) return false;
    if (!sigma(block, row, *plan_[Quantity::sigma_y], y, problem)) return false;
  }
  double z = axial_over_lateral * std::sqrt((x * x + y * y) / 2);
  if (plan_[Quantity::sigma_z] && !sigma(block, row, *plan_[Quantity::sigma_z], z, problem)) return false;
  covariance = {static_cast<float>(x * x), 0, 0, static_cast<float>(y * y), 0, static_cast<float>(z * z)};
  return true;
}

bool TableBuilder::full_covariance(const RowBlock& block, std::size_t row, Covariance& covariance,
                                   Problem& problem) const {
  std::array<double, 6> c{};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& planned = plan_.used[static_cast<std::size_t>(Quantity::sigma_xx) + i];
    if (planned) c[i] = planned->factor * planned->factor * block.columns[planned->column][row];
  }
  if (planar_) c[5] = axial_over_lateral * axial_over_lateral * (c[0] + c[3]) / 2;
  // Leading minors, scaled by the diagonal so that "almost singular" means the same in every unit.
  const double two = c[0] * c[3] - c[1] * c[1];
  const double three = c[0] * (c[3] * c[5] - c[4] * c[4]) - c[1] * (c[1] * c[5] - c[4] * c[2]) +
                       c[2] * (c[1] * c[4] - c[3] * c[2]);
  constexpr double least = 1e-9;
  constexpr double smallest = smallest_sigma_nm * smallest_sigma_nm;
  constexpr double largest = largest_nm * largest_nm;
  const bool positive = c[0] >= smallest && c[3] >= smallest && c[5] >= smallest && c[0] <= largest &&
                        c[3] <= largest && c[5] <= largest && two > least * c[0] * c[3] &&
                        three > least * c[0] * c[3] * c[5];
  if (!positive) {
    problem = {"covariance is not positive definite", plan_[Quantity::sigma_xx]->column};
    return false;
  }
  for (std::size_t i = 0; i < 6; ++i) covariance[i] = static_cast<float>(c[i]);
  return true;
}

bool TableBuilder::convert_row(const RowBlock& block, std::size_t row, std::array<double, 3>& position,
                               Covariance& covariance, Problem& problem) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& planned = plan_.used[axis];
    if (!planned) continue;
    const double value = planned->factor * block.columns[planned->column][row];
    if (!(std::abs(value) <= largest_nm)) {
      problem = {std::isfinite(value) ? "position is out of range" : "position is not finite",
                 planned->column};
      return false;
    }
    position[axis] = value;
  }
  return plan_.full_covariance() ? full_covariance(block, row, covariance, problem)
                                 : standard_deviations(block, row, covariance, problem);
}

void TableBuilder::fail(const RowBlock& block, std::size_t row, const Problem& problem) const {
  const SourceColumn& column = columns_[problem.column];
  const std::string place = block.line.empty() ? where_ + ": row " + std::to_string(block.row[row])
                                               : where_ + ":" + std::to_string(block.line[row]) + ":" +
                                                     std::to_string(problem.column + 1);
  throw Error(Fault::input, place,
              problem.reason + " (column '" + column.name + "' is " +
                  number_text(block.columns[problem.column][row]) + ")",
              "correct the row, or leave such rows out with input.drop_nonfinite");
}

std::int64_t TableBuilder::particle_of(const RowBlock& block, std::size_t row) {
  const auto& planned = plan_[Quantity::particle];
  if (!planned) return -1;
  const double value = block.columns[planned->column][row];
  if (std::isnan(value)) return -1;
  if (!columns_[planned->column].text) {
    return number_text(value) == plan_.unassigned_particle ? -1 : particles_.of_number(value);
  }
  const std::string& word = labels_[planned->column].names()[static_cast<std::size_t>(value)];
  return word == plan_.unassigned_particle ? -1 : particles_.of_text(word);
}

void TableBuilder::require_memory_for(std::uint64_t rows) const {
  static const double installed = installed_gibibytes();
  constexpr std::size_t fixed_bytes = sizeof(std::array<double, 3>) + sizeof(Covariance) +
                                      sizeof(std::int64_t) + sizeof(std::uint32_t) + sizeof(std::uint64_t);
  const double needed = static_cast<double>(rows) *
                        static_cast<double>(fixed_bytes + plan_.extra.size() * sizeof(double)) / gibibyte;
  if (needed < installed) return;
  throw Error(Fault::resource, where_,
              "holds " + std::to_string(rows) + " rows or more, which need " +
                  std::to_string(std::llround(std::ceil(needed))) + " GiB of memory; this machine has " +
                  std::to_string(std::llround(installed)) + " GiB",
              "split the table, or use a machine with more memory");
}

void TableBuilder::append(const RowBlock& block) {
  require_memory_for(table_.size() + block.row.size());
  for (std::size_t row = 0; row < block.row.size(); ++row) {
    std::array<double, 3> position{};
    Covariance covariance{};
    Problem problem;
    const std::int64_t particle = particle_of(block, row);  // also of rejected rows: the particle exists
    if (!convert_row(block, row, position, covariance, problem)) {
      const auto& sigma_z = plan_[Quantity::sigma_z];
      const bool unknown = infinite_sigma_z_rejected_ && sigma_z && problem.column == sigma_z->column &&
                           std::isinf(block.columns[problem.column][row]);
      if (!drop_ && !unknown) fail(block, row, problem);
      reject(unknown ? "axial uncertainty is infinite" : problem.reason, block.row[row]);
      continue;
    }
    table_.position_nm.push_back(position);
    table_.covariance_nm2.push_back(covariance);
    table_.particle.push_back(particle);
    table_.source_file.push_back(0);
    table_.source_row.push_back(block.row[row]);
    for (std::size_t i = 0; i < plan_.extra.size(); ++i) {
      table_.extra[i].values.push_back(block.columns[plan_.extra[i]][row]);
    }
  }
}

void TableBuilder::reject(const std::string& reason, std::uint64_t row, std::uint64_t rows) {
  const auto known = std::find_if(table_.rejected.begin(), table_.rejected.end(),
                                  [&](const Rejection& r) { return r.reason == reason; });
  if (known != table_.rejected.end()) {
    known->rows += rows;
  } else {
    table_.rejected.push_back({reason, rows, 0, row});
  }
}

LocalisationTable TableBuilder::finish() {
  table_.particle_names = particles_.take();
  for (std::size_t i = 0; i < plan_.extra.size(); ++i) {
    if (columns_[plan_.extra[i]].text) table_.extra[i].labels = labels_[plan_.extra[i]].take();
  }
  return std::move(table_);
}

}  // namespace smlm
