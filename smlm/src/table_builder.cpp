#include "table_builder.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>

#include "missing.hpp"
#include "smlm/error.hpp"
#include "smlm/number_text.hpp"
#include "text/number.hpp"

namespace smlm {
namespace {

// A metre: no microscope's coordinate is larger, and squares stay far from the ends of float.
constexpr double largest_nm = 1e9;
constexpr double smallest_sigma_nm = 1e-9;
// What the field's programs assume where the axial precision is not known (Picasso, napari-storm).
constexpr double axial_over_lateral = 2.0;
// Of a covariance, divided by the product of its diagonal.
constexpr double least_determinant = 1e-9;
// z says nothing where it spans less than an atom, or is the same in all but one row of a hundred.
constexpr double smallest_depth_nm = 0.01;
constexpr double most_off_plane = 0.01;
constexpr std::size_t fewest_for_a_plane = 10;
constexpr auto remedy = "correct the row, or leave such rows out with input.drop_nonfinite";
constexpr double gibibyte = 1024.0 * 1024 * 1024;

double installed_gibibytes() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE)) / gibibyte;
}

// Calls visit(vector) for everything that has one value a row.
template <class Visit>
void every_column(LocalisationTable& table, const Visit& visit) {
  visit(table.position_nm);
  visit(table.covariance_nm2);
  visit(table.particle);
  visit(table.source_file);
  visit(table.source_row);
  for (ExtraColumn& extra : table.extra) visit(extra.values);
}

}  // namespace

TableBuilder::TableBuilder(std::string file, std::string where, std::vector<SourceColumn> columns,
                           const ReadOptions& options)
    : where_(std::move(where)),
      columns_(std::move(columns)),
      plan_(plan_columns(where_, columns_, options)),
      drop_(options.drop_nonfinite),
      planar_(!plan_[Quantity::z]),
      positions_only_(options.positions_only),
      assumed_sigma_nm_(options.assumed_sigma_nm),
      labels_(columns_.size()) {
  table_.files.push_back(std::move(file));
  table_.mapping = plan_.mapping;
  table_.warnings = plan_.warnings;
  table_.keys_used = plan_.keys_used;
  table_.position_unit_nm = plan_[Quantity::x]->factor;
  table_.planar = planar_;
  for (const std::size_t column : plan_.extra) {
    table_.extra.push_back({columns_[column].name, columns_[column].unit, {}, {}});
  }
  table_.sigma_assumed = !plan_.has_uncertainty();
  table_.axial_sigma_assumed = !planar_ && !plan_.has_axial_uncertainty();
  if (table_.sigma_assumed && !options.positions_only) {
    table_.keys_used.insert("assumed_sigma_nm");
    table_.warnings.push_back("has no uncertainties: " + number_text(assumed_sigma_nm_) +
                              " nm is assumed laterally (input.assumed_sigma_nm)");
  }
}

double TableBuilder::label(std::size_t column, std::string_view word) {
  const auto& particle = plan_[Quantity::particle];
  const bool names_particle = particle && particle->column == column;
  if (word.empty() && !names_particle) return std::nan("");
  return static_cast<double>(labels_[column].of_text(word));
}

void TableBuilder::make_text(std::size_t column, std::vector<double>& block_values) {
  const auto become_words = [&](std::vector<double>& values) {
    for (double& value : values) {
      if (!std::isnan(value)) value = label(column, number_text(value));
    }
  };
  for (std::size_t i = 0; i < plan_.extra.size(); ++i) {
    if (plan_.extra[i] == column) become_words(table_.extra[i].values);
  }
  become_words(block_values);
  columns_[column].text = true;
}

std::string TableBuilder::words(Reason reason, bool of_no_particle) {
  static constexpr const char* texts[]{"",
                                       "position is not finite",
                                       "position is out of range",
                                       "uncertainty is not finite",
                                       "uncertainty is not positive",
                                       "uncertainty is out of range",
                                       "axial uncertainty is infinite",
                                       "covariance is not positive definite"};
  return std::string(texts[static_cast<std::size_t>(reason)]) + (of_no_particle ? ", in no particle" : "");
}

TableBuilder::Problem TableBuilder::sigma(const RowBlock& block, std::size_t row,
                                          const PlannedColumn& planned, double& value) const {
  const double raw = block.columns[planned.column][row];
  value = planned.factor * (planned.spread == Spread::variance && raw > 0 ? std::sqrt(raw) : raw);
  if (value >= smallest_sigma_nm && value <= largest_nm) return {};
  return {!std::isfinite(raw) ? Reason::sigma_not_finite
          : raw <= 0          ? Reason::sigma_not_positive
                              : Reason::sigma_out_of_range,
          planned.column};
}

TableBuilder::Problem TableBuilder::lateral_part(const RowBlock& block, std::size_t row,
                                                 std::array<double, 3>& position,
                                                 Covariance& covariance) const {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const PlannedColumn& planned = *plan_.used[axis];
    position[axis] = planned.factor * block.columns[planned.column][row];
    if (!(std::abs(position[axis]) <= largest_nm)) {
      return {std::isfinite(position[axis]) ? Reason::position_out_of_range : Reason::position_not_finite,
              planned.column};
    }
  }
  double x = assumed_sigma_nm_, y = assumed_sigma_nm_, xy = 0;
  if (plan_.full_covariance()) {
    const auto element = [&](Quantity q) {
      const auto& planned = plan_[q];
      return planned ? planned->factor * planned->factor * block.columns[planned->column][row] : 0.0;
    };
    const double xx = element(Quantity::sigma_xx), yy = element(Quantity::sigma_yy);
    xy = element(Quantity::sigma_xy);
    if (!(xx >= smallest_sigma_nm * smallest_sigma_nm && yy >= smallest_sigma_nm * smallest_sigma_nm &&
          xx <= largest_nm * largest_nm && yy <= largest_nm * largest_nm &&
          xx * yy - xy * xy > least_determinant * xx * yy)) {
      return {Reason::not_positive_definite, plan_[Quantity::sigma_xx]->column};
    }
    covariance = {static_cast<float>(xx), static_cast<float>(xy), 0, static_cast<float>(yy), 0, 0};
    return {};
  }
  if (plan_[Quantity::sigma_lateral]) {
    if (const Problem p = sigma(block, row, *plan_[Quantity::sigma_lateral], x); p.reason != Reason::none)
      return p;
    y = x;
  } else if (plan_[Quantity::sigma_x]) {
    if (const Problem p = sigma(block, row, *plan_[Quantity::sigma_x], x); p.reason != Reason::none) return p;
    if (const Problem p = sigma(block, row, *plan_[Quantity::sigma_y], y); p.reason != Reason::none) return p;
  }
  covariance = {static_cast<float>(x * x), 0, 0, static_cast<float>(y * y), 0, 0};
  return {};
}

TableBuilder::Problem TableBuilder::axial_part(const RowBlock& block, std::size_t row,
                                               std::array<double, 3>& position,
                                               Covariance& covariance) const {
  const double assumed = axial_over_lateral * axial_over_lateral *
                         (static_cast<double>(covariance[0]) + static_cast<double>(covariance[3])) / 2;
  covariance[5] = static_cast<float>(assumed);
  if (planar_) return {};
  const PlannedColumn& z = *plan_[Quantity::z];
  position[2] = z.factor * block.columns[z.column][row];
  if (!(std::abs(position[2]) <= largest_nm)) {
    return {std::isfinite(position[2]) ? Reason::position_out_of_range : Reason::position_not_finite,
            z.column};
  }
  if (plan_.full_covariance()) {
    const auto element = [&](Quantity q) {
      const auto& planned = plan_[q];
      return planned ? planned->factor * planned->factor * block.columns[planned->column][row] : 0.0;
    };
    const double xx = element(Quantity::sigma_xx), xy = element(Quantity::sigma_xy),
                 xz = element(Quantity::sigma_xz), yy = element(Quantity::sigma_yy),
                 yz = element(Quantity::sigma_yz),
                 zz = plan_[Quantity::sigma_zz] ? element(Quantity::sigma_zz) : assumed;
    // The determinant, scaled by the diagonal so that "almost singular" means the same in every unit.
    const double three = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    if (!(zz >= smallest_sigma_nm * smallest_sigma_nm && zz <= largest_nm * largest_nm &&
          three > least_determinant * xx * yy * zz)) {
      return {Reason::not_positive_definite, plan_[Quantity::sigma_xx]->column};
    }
    covariance[2] = static_cast<float>(xz);
    covariance[4] = static_cast<float>(yz);
    covariance[5] = static_cast<float>(zz);
    return {};
  }
  if (!plan_[Quantity::sigma_z]) return {};
  double sigma_z = 0;
  Problem problem = sigma(block, row, *plan_[Quantity::sigma_z], sigma_z);
  if (problem.reason == Reason::none) covariance[5] = static_cast<float>(sigma_z * sigma_z);
  if (infinite_sigma_z_rejected_ && std::isinf(block.columns[plan_[Quantity::sigma_z]->column][row]))
    problem.reason = Reason::sigma_z_infinite;
  return problem;
}

std::string TableBuilder::failure(const RowBlock& block, std::size_t row, const Problem& problem) const {
  const SourceColumn& column = columns_[problem.column];
  const double value = block.columns[problem.column][row];
  const std::string place = block.line.empty()
                                ? "row " + std::to_string(block.row[row])
                                : std::to_string(block.line[row]) + ":" + std::to_string(problem.column + 1);
  return (block.line.empty() ? ": " : ":") + place + ": " + words(problem.reason, false) + " (column '" +
         column.name + "' is " + (std::isnan(value) ? "empty or no number" : number_text(value)) + ")";
}

// Rows that are left out without a word of the user's: nobody asks for what is in no particle.
bool TableBuilder::excused(const Problem& problem, std::int64_t particle) const {
  return drop_ || problem.reason == Reason::sigma_z_infinite || (plan_[Quantity::particle] && particle < 0);
}

std::int64_t TableBuilder::particle_of_name(std::string_view name) {
  if (!names_no_particle(name, plan_.unassigned_particle)) return particles_.of_text(name);
  const auto& stated = plan_.unassigned_particle;
  if (!names_no_particle(name, {}) || std::find(stated.begin(), stated.end(), name) != stated.end())
    table_.keys_used.insert("unassigned_particle");
  return -1 - none_names_.of_text(name);
}

bool TableBuilder::is_no_particle(double value) {
  if (!plan_[Quantity::particle]) return false;
  const std::size_t column = plan_[Quantity::particle]->column;
  return columns_[column].text && !std::isnan(value)
             ? names_no_particle(labels_[column].name(static_cast<std::int64_t>(value)),
                                 plan_.unassigned_particle)
             : !(value >= 0);
}

// Index of the particle; -1, -2, ... for the names of none.
std::int64_t TableBuilder::particle_of(const RowBlock& block, std::size_t row) {
  const auto& planned = plan_[Quantity::particle];
  if (!planned) return -1;
  const double value = block.columns[planned->column][row];
  if (!columns_[planned->column].text) {
    if (value != last_number_) {
      last_number_ = value;
      last_particle_ = particle_of_name(number_text(value));
    }
    return last_particle_;
  }
  const auto index = static_cast<std::size_t>(value);
  while (particle_of_label_.size() <= index) {
    const auto next = static_cast<std::int64_t>(particle_of_label_.size());
    particle_of_label_.push_back(particle_of_name(labels_[planned->column].name(next)));
  }
  return particle_of_label_[index];
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

void TableBuilder::reserve(std::uint64_t rows) {
  every_column(table_, [&](auto& column) { column.reserve(rows); });
}

void TableBuilder::append(const RowBlock& block) {
  require_memory_for(table_.size() + block.row.size());
  for (std::size_t row = 0; row < block.row.size(); ++row) {
    std::array<double, 3> position{};
    Covariance covariance{};
    const std::int64_t particle = particle_of(block, row);  // also of rejected rows: the particle exists
    if (particle < 0 && plan_[Quantity::particle]) {
      none_rows_.resize(none_names_.size(), 0);
      ++none_rows_[static_cast<std::size_t>(-1 - particle)];
    }
    const Problem lateral = lateral_part(block, row, position, covariance);
    if (lateral.reason != Reason::none) {
      if (!excused(lateral, particle))
        throw Error(Fault::input, where_ + failure(block, row, lateral), "", remedy);
      reject(words(lateral.reason, !drop_), block.row[row]);
      continue;
    }
    const Problem axial = axial_part(block, row, position, covariance);
    if (axial.reason != Reason::none) {
      suspended_.push_back({table_.size(), axial.reason});
      if (first_failure_.empty() && !excused(axial, particle)) first_failure_ = failure(block, row, axial);
    }
    table_.position_nm.push_back(position);
    table_.covariance_nm2.push_back(covariance);
    table_.particle.push_back(std::max<std::int64_t>(particle, -1));
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

// The value of z that nearly all rows with a z have, or nothing.
std::optional<double> common_z(const LocalisationTable& table, std::size_t& others) {
  // The only value that can be of a majority survives this (Boyer and Moore).
  double candidate = 0;
  std::size_t lead = 0, rows = 0, equal = 0;
  for (const auto& position : table.position_nm) {
    if (!std::isfinite(position[2])) continue;
    ++rows;
    if (lead == 0) candidate = position[2];
    lead += position[2] == candidate ? 1 : std::size_t(-1);
  }
  for (const auto& position : table.position_nm) equal += position[2] == candidate;
  others = rows - equal;
  if (rows == 0 || static_cast<double>(others) > most_off_plane * static_cast<double>(rows))
    return std::nullopt;
  return candidate;
}

bool TableBuilder::flatten() {
  if (planar_ || table_.size() == 0) return false;
  const std::string name = "z ('" + columns_[plan_[Quantity::z]->column].name + "')";
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const auto& position : table_.position_nm) {
    if (!std::isfinite(position[2])) continue;
    least = std::min(least, position[2]);
    most = std::max(most, position[2]);
  }
  if (positions_only_) {  // what is flat in space stays so
    table_.planar = least > most;
    if (table_.planar) {
      for (auto& position : table_.position_nm) position[2] = 0;
    }
    return table_.planar;
  }
  std::string why;
  if (least > most) {
    why = name + " is empty throughout";
  } else if (most - least < smallest_depth_nm) {
    table_.maybe_planar = table_.size() < fewest_for_a_plane && least == most;
    if (table_.maybe_planar) return false;
    why = name + (least == most ? " is " + number_text(least) + " nm throughout"
                                : " spans " + number_text(most - least) + " nm, less than an atom");
  } else {
    std::size_t others = 0;
    const auto common = common_z(table_, others);
    if (!common) return false;
    why = name + " is " + number_text(*common) + " nm in all rows but " + std::to_string(others);
  }
  table_.warnings.push_back(why + ": registered in the plane");
  for (std::size_t row = 0; row < table_.size(); ++row) {
    table_.position_nm[row][2] = 0;
    Covariance& c = table_.covariance_nm2[row];
    c[2] = c[4] = 0;
    c[5] = static_cast<float>(axial_over_lateral * axial_over_lateral *
                              (static_cast<double>(c[0]) + static_cast<double>(c[3])) / 2);
  }
  table_.planar = true;
  table_.axial_sigma_assumed = false;
  return true;
}

void TableBuilder::drop_suspended() {
  if (suspended_.empty()) return;
  if (!first_failure_.empty()) throw Error(Fault::input, where_ + first_failure_, "", remedy);
  std::vector<std::size_t> kept;
  std::size_t next = 0;
  for (std::size_t row = 0; row < table_.size(); ++row) {
    if (next == suspended_.size() || suspended_[next].row != row) {
      kept.push_back(row);
      continue;
    }
    const Reason reason = suspended_[next++].reason;
    reject(words(reason, !drop_ && reason != Reason::sigma_z_infinite), table_.source_row[row]);
  }
  every_column(table_, [&](auto& column) {
    for (std::size_t i = 0; i < kept.size(); ++i) column[i] = column[kept[i]];
    column.resize(kept.size());
  });
}

// Ids that are the same number may be meant to be one particle.
void TableBuilder::warn_about_similar_names() {
  std::unordered_map<double, const std::string*> spelling;
  std::size_t pairs = 0;
  std::string example;
  for (const std::string& name : table_.particle_names) {
    double value = 0;
    if (!parse_number(name, value)) continue;
    // Beyond 2^53 neighbours are one double: whole numbers with other digits are other numbers.
    const bool digits_only =
        std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits_only && name.front() != '0' && value > 9e15) continue;
    const auto [found, fresh] = spelling.emplace(value, &name);
    if (fresh) continue;
    if (pairs++ == 0) example = "'" + *found->second + "' and '" + name + "'";
  }
  if (pairs > 0) {
    table_.warnings.push_back("particle ids are compared as text: " + example + " are different particles" +
                              (pairs > 1 ? " (and " + std::to_string(pairs - 1) + " more such pairs)" : ""));
  }
}

// Programs that keep ids as floating-point numbers write "1.0000" or "1.0e+00"; where all are whole, the
// digits behind the point say nothing.
void TableBuilder::strip_decimals() {
  std::set<std::string> seen;
  std::vector<std::string> whole;
  for (const std::string& name : table_.particle_names) {
    double value = 0;
    if (name.find('.') == std::string::npos || !parse_number(name, value) || value != std::trunc(value) ||
        !seen.insert(number_text(value)).second)
      return;
    whole.push_back(number_text(value));
  }
  if (whole.empty()) return;
  table_.warnings.push_back("particle ids are whole numbers written with decimals ('" +
                            table_.particle_names.front() + "'): written as '" + whole.front() + "'");
  table_.particle_names = std::move(whole);
}

LocalisationTable TableBuilder::finish() {
  if (!flatten()) drop_suspended();
  if (table_.axial_sigma_assumed && !table_.sigma_assumed && !positions_only_)
    table_.warnings.emplace_back("has no axial uncertainty: twice the lateral one is assumed");
  table_.particle_names = particles_.take();
  strip_decimals();
  warn_about_similar_names();
  std::vector<std::string> none = none_names_.take();
  for (std::size_t i = 0; i < none.size(); ++i)
    table_.unassigned.emplace_back(std::move(none[i]), none_rows_[i]);
  for (std::size_t i = 0; i < plan_.extra.size(); ++i) {
    if (columns_[plan_.extra[i]].text) table_.extra[i].labels = labels_[plan_.extra[i]].take();
  }
  return std::move(table_);
}

}  // namespace smlm
