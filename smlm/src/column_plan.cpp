#include "column_plan.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>

#include "name_index.hpp"
#include "smlm/error.hpp"

namespace smlm {
namespace {

struct Candidate {
  std::size_t column = 0;
  std::string unit;
  Spread spread = Spread::standard_deviation;
  bool weak = false;
};

constexpr std::initializer_list<Quantity> standard_deviations{Quantity::sigma_x, Quantity::sigma_y,
                                                              Quantity::sigma_z, Quantity::sigma_lateral};
constexpr std::initializer_list<Quantity> covariances{Quantity::sigma_xx, Quantity::sigma_xy,
                                                      Quantity::sigma_xz, Quantity::sigma_yy,
                                                      Quantity::sigma_yz, Quantity::sigma_zz};

bool one_of(Quantity q, std::initializer_list<Quantity> set) {
  return std::find(set.begin(), set.end(), q) != set.end();
}
bool is_position(Quantity q) { return q <= Quantity::z; }
bool is_covariance(Quantity q) { return one_of(q, covariances); }
bool is_uncertainty(Quantity q) { return one_of(q, standard_deviations) || is_covariance(q); }

class Planner {
 public:
  Planner(const std::string& file, const std::vector<SourceColumn>& columns, const ReadOptions& options)
      : file_(file), columns_(columns), options_(options), candidates_(ColumnPlan::quantities) {}

  ColumnPlan plan() {
    gather_from_header();
    gather_from_options();
    for (std::size_t q = 0; q < ColumnPlan::quantities; ++q) choose(static_cast<Quantity>(q));
    settle_uncertainties();
    require_positions();
    for (std::size_t q = 0; q < ColumnPlan::quantities; ++q) convert(static_cast<Quantity>(q));
    warn_about_units();
    collect_extras();
    return std::move(plan_);
  }

 private:
  std::vector<Candidate>& of(Quantity q) { return candidates_[static_cast<std::size_t>(q)]; }
  bool has(Quantity q) { return !of(q).empty(); }

  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(Fault::input, file_, what, remedy);
  }

  void gather_from_header() {
    bool covariance = false;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const SourceColumn& column = columns_[i];
      if (column.quantity) {
        if (*column.quantity != Quantity::other)
          of(*column.quantity).push_back({i, column.unit, column.spread, false});
        covariance = covariance || column.quantity == Quantity::sigma_xx;
        continue;
      }
      const auto match = match_heading(parse_heading(column.name));
      if (!match || (column.text && match->quantity != Quantity::particle)) continue;
      const std::string unit = column.unit.empty() ? match->unit : column.unit;
      of(match->quantity)
          .push_back(
              {i, unit, is_covariance(match->quantity) ? Spread::variance : column.spread, match->weak});
      covariance = covariance || match->quantity == Quantity::sigma_xx;
    }
    if (covariance) take_sigma_xy_as_covariance();
  }

  // Beside sigma_xx, "sigma_xy" is the off-diagonal element; elsewhere the lateral standard deviation.
  void take_sigma_xy_as_covariance() {
    auto& lateral = of(Quantity::sigma_lateral);
    const auto moved = std::find_if(lateral.begin(), lateral.end(), [&](const Candidate& c) {
      return parse_heading(columns_[c.column].name).name == "sigma_xy";
    });
    if (moved == lateral.end()) return;
    of(Quantity::sigma_xy).push_back({moved->column, moved->unit, Spread::variance, false});
    lateral.erase(moved);
  }

  std::size_t find_column(const std::string& key, const std::string& name) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].name == name) return i;
    }
    const std::string wanted = parse_heading(name).name;
    std::vector<std::size_t> similar;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (parse_heading(columns_[i].name).name == wanted) similar.push_back(i);
    }
    if (similar.size() == 1) return similar.front();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number >= 1 &&
        number <= columns_.size()) {
      return number - 1;
    }
    fail("has no column '" + name + "', which input.columns." + key + " names",
         "its columns are " + list_columns(columns_));
  }

  void gather_from_options() {
    const bool covariance = options_.columns.count("sigma_xx") > 0;
    bool uncertainty_mapped = false;
    for (const auto& [key, mapping] : options_.columns) {
      const auto q = quantity_named(key);
      uncertainty_mapped = uncertainty_mapped || (q && is_uncertainty(*q));
    }
    if (uncertainty_mapped) {
      for (const Quantity q : standard_deviations) of(q).clear();
      for (const Quantity q : covariances) of(q).clear();
    }
    for (const auto& [key, mapping] : options_.columns) {
      auto q = quantity_named(key);
      if (!q) continue;  // violations() has reported it
      if (q == Quantity::sigma_lateral && covariance) q = Quantity::sigma_xy;
      const bool variance = mapping.kind == "variance" || is_covariance(*q);
      const std::size_t column = find_column(key, mapping.name);
      for (auto& others : candidates_) {
        others.erase(std::remove_if(others.begin(), others.end(),
                                    [&](const Candidate& c) { return c.column == column; }),
                     others.end());
      }
      of(*q) = {{column, mapping.unit, variance ? Spread::variance : Spread::standard_deviation, false}};
    }
  }

  // Leaves at most one candidate: a strong name before a weak one, lengths before the same in pixels.
  void choose(Quantity q) {
    auto& list = of(q);
    const auto keep_if_any = [&list](const auto& wanted) {
      if (list.size() > 1 && std::any_of(list.begin(), list.end(), wanted)) {
        list.erase(std::remove_if(list.begin(), list.end(), [&](const Candidate& c) { return !wanted(c); }),
                   list.end());
      }
    };
    keep_if_any([](const Candidate& c) { return !c.weak; });
    keep_if_any([](const Candidate& c) {
      const auto unit = units::parse_length(c.unit);
      return unit && *unit != units::Length::pixel;
    });
    if (list.size() < 2) return;
    std::string names;
    for (const Candidate& c : list) names += (names.empty() ? "'" : ", '") + columns_[c.column].name + "'";
    const std::string key(column_spec(q).name);
    fail("several columns could be " + key + ": " + names, "name one under input.columns." + key);
  }

  // One way of giving uncertainties: full covariances, else one value per axis, else one lateral value.
  void settle_uncertainties() {
    if (has(Quantity::sigma_xx) || has(Quantity::sigma_yy) || has(Quantity::sigma_zz)) {
      if (!has(Quantity::sigma_xx) || !has(Quantity::sigma_yy) ||
          (has(Quantity::z) && !has(Quantity::sigma_zz))) {
        fail("a covariance needs sigma_xx, sigma_yy and, with z, sigma_zz",
             "name them all under input.columns");
      }
      for (const Quantity q : standard_deviations) of(q).clear();
    } else {
      for (const Quantity q : covariances) of(q).clear();
    }
    if (has(Quantity::sigma_x) != has(Quantity::sigma_y)) {
      if (!has(Quantity::sigma_lateral)) {
        fail("has an uncertainty of only one of x and y", "name the other, or sigma_xy, under input.columns");
      }
      of(Quantity::sigma_x).clear();
      of(Quantity::sigma_y).clear();
    }
    if (has(Quantity::sigma_x)) of(Quantity::sigma_lateral).clear();
    if (!has(Quantity::z)) {
      for (const Quantity q : {Quantity::sigma_z, Quantity::sigma_xz, Quantity::sigma_yz, Quantity::sigma_zz})
        of(q).clear();
    }
  }

  void require_positions() {
    for (const Quantity q : {Quantity::x, Quantity::y}) {
      if (has(q)) continue;
      const std::string key(column_spec(q).name);
      if (!columns_.empty() && columns_.front().name == "1") {
        fail("has no header", "say which column is what, e.g. input.columns." + key + ": {name: '1'}");
      }
      fail("no column is known as " + key + "; its columns are " + list_columns(columns_),
           "name it under input.columns." + key);
    }
  }

  double length_factor(Quantity q, const Candidate& candidate) {
    if (columns_[candidate.column].unit_nm > 0 && candidate.unit == columns_[candidate.column].unit) {
      return columns_[candidate.column].unit_nm;
    }
    std::string text = candidate.unit;
    for (const std::string_view square : {"^2", "\xC2\xB2"}) {
      const auto at = text.find(square);
      if (at != std::string::npos) text.resize(at);
    }
    const std::string& column = columns_[candidate.column].name;
    if (text.empty()) {
      if (!options_.unit.empty()) {
        text = options_.unit;
      } else if (is_position(q)) {
        unitless_positions_ += (unitless_positions_.empty() ? "'" : ", '") + column + "'";
        text = "nm";
      } else {
        unitless_uncertainties_ += (unitless_uncertainties_.empty() ? "'" : ", '") + column + "'";
        const bool axial = q == Quantity::sigma_z;
        return plan_[axial ? Quantity::z : Quantity::x]->factor;
      }
    }
    const auto unit = units::parse_length(text);
    if (!unit)
      fail("column '" + column + "' is in '" + text + "', which is not a length",
           "give its unit under input.columns");
    if (*unit == units::Length::pixel && !(options_.pixel_size_nm > 0)) {
      fail("column '" + column + "' is in pixels and their size is not known", "set input.pixel_size_nm");
    }
    return units::to_nm(*unit, options_.pixel_size_nm);
  }

  void convert(Quantity q) {
    if (!has(q)) return;
    const Candidate& candidate = of(q).front();
    const SourceColumn& source = columns_[candidate.column];
    PlannedColumn planned{candidate.column, 1.0, candidate.spread};
    const bool length = is_position(q) || is_uncertainty(q);
    if (length) planned.factor = length_factor(q, candidate);
    plan_.used[static_cast<std::size_t>(q)] = planned;
    std::string line = std::string(column_spec(q).name) + " <- '" + source.name + "'";
    if (length) {
      const bool square = planned.spread == Spread::variance;
      line += square ? " (variance, in (" : " (in ";
      line += number_text(planned.factor) + " nm" + (square ? ")^2)" : ")");
    }
    plan_.mapping.push_back(line);
    if (candidate.weak) {
      plan_.warnings.push_back(
          "column '" + source.name + "' is taken as " + std::string(column_spec(q).meaning) +
          "; name the right one under input.columns." + std::string(column_spec(q).name));
    }
    if (q == Quantity::particle) {
      const bool smap = parse_heading(source.name).name.rfind("sitenumber", 0) == 0;  // SMAP: 0 is "no site"
      plan_.unassigned_particle = !options_.unassigned_particle.empty() ? options_.unassigned_particle
                                  : smap                                ? "0"
                                                                        : "-1";
    }
  }

  void warn_about_units() {
    if (!unitless_positions_.empty()) {
      plan_.warnings.push_back(unitless_positions_ +
                               " carry no unit: taken as nm (input.unit says otherwise)");
    }
    if (!unitless_uncertainties_.empty()) {
      plan_.warnings.push_back(unitless_uncertainties_ +
                               " carry no unit: taken in the unit of the positions");
    }
  }

  // Frame, photons and background are known by name but only kept.
  void collect_extras() {
    std::vector<bool> taken(columns_.size(), false);
    for (std::size_t q = 0; q < ColumnPlan::quantities; ++q) {
      const auto quantity = static_cast<Quantity>(q);
      if (plan_.used[q] && quantity != Quantity::frame && quantity != Quantity::photons &&
          quantity != Quantity::background) {
        taken[plan_.used[q]->column] = true;
      }
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (!taken[i] && !columns_[i].name.empty()) plan_.extra.push_back(i);
    }
  }

  const std::string& file_;
  const std::vector<SourceColumn>& columns_;
  const ReadOptions& options_;
  std::vector<std::vector<Candidate>> candidates_;
  std::string unitless_positions_, unitless_uncertainties_;
  ColumnPlan plan_;
};

}  // namespace

std::string list_columns(const std::vector<SourceColumn>& columns) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(columns.size(), most); ++i) {
    text += (i == 0 ? "'" : ", '") + columns[i].name + "'";
  }
  if (columns.size() > most) text += " and " + std::to_string(columns.size() - most) + " more";
  return text;
}

ColumnPlan plan_columns(const std::string& file, const std::vector<SourceColumn>& columns,
                        const ReadOptions& options) {
  return Planner(file, columns, options).plan();
}

}  // namespace smlm
