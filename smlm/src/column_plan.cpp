#include "column_plan.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>

#include "smlm/error.hpp"
#include "smlm/number_text.hpp"

namespace smlm {
namespace {

struct Candidate {
  std::size_t column = 0;
  std::string unit;
  Spread spread = Spread::standard_deviation;
  Claim claim = Claim::plain;
  bool mapped = false;  // by input.columns
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
    if (options_.planar && has(Quantity::z)) {
      plan_.keys_used.insert("planar");
      of(Quantity::z).clear();
    }
    prefer_uncertainties_to_widths();
    for (std::size_t q = 0; q < ColumnPlan::quantities; ++q) choose(static_cast<Quantity>(q));
    settle_uncertainties();
    require_positions();
    for (std::size_t q = 0; q < ColumnPlan::quantities; ++q) convert(static_cast<Quantity>(q));
    warn_about_units();
    warn_about_untaken();
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
          of(*column.quantity).push_back({i, column.unit, column.spread});
        covariance = covariance || column.quantity == Quantity::sigma_xx;
        continue;
      }
      const auto match = match_heading(parse_heading(column.name));
      if (!match || (column.text && match->quantity != Quantity::particle)) continue;
      const std::string unit = column.unit.empty() ? match->unit : column.unit;
      const Spread spread = column.spread == Spread::variance ? column.spread : match->spread;
      of(match->quantity).push_back({i, unit, spread, match->claim});
      covariance = covariance || match->quantity == Quantity::sigma_xx;
    }
    if (covariance) take_sigma_xy_as_covariance();
    if (options_.positions_only) {
      for (const Quantity q : standard_deviations) of(q).clear();
      for (const Quantity q : covariances) of(q).clear();
    }
  }

  // Beside sigma_xx, "sigma_xy" is the off-diagonal element; elsewhere the lateral standard deviation.
  void take_sigma_xy_as_covariance() {
    auto& lateral = of(Quantity::sigma_lateral);
    const auto moved = std::find_if(lateral.begin(), lateral.end(), [&](const Candidate& c) {
      return parse_heading(columns_[c.column].name).name == "sigma_xy";
    });
    if (moved == lateral.end()) return;
    of(Quantity::sigma_xy).push_back({moved->column, moved->unit, Spread::variance});
    lateral.erase(moved);
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
      const std::size_t column = find_mapped_column(file_, columns_, key, mapping.name);
      const auto by_name = match_heading(parse_heading(columns_[column].name));
      const bool says_variance =
          columns_[column].spread == Spread::variance || (by_name && by_name->spread == Spread::variance);
      const bool variance =
          is_covariance(*q) || mapping.kind == "variance" || (mapping.kind.empty() && says_variance);
      for (auto& others : candidates_) {
        others.erase(std::remove_if(others.begin(), others.end(),
                                    [&](const Candidate& c) { return c.column == column; }),
                     others.end());
      }
      of(*q) = {{column, mapped_unit(key, mapping, column),
                 variance ? Spread::variance : Spread::standard_deviation, Claim::plain, true}};
    }
  }

  // What the header says of a unit holds unless the mapping says another.
  std::string mapped_unit(const std::string& key, const ColumnMapping& mapping, std::size_t column) {
    std::string stated = columns_[column].unit;
    const Heading heading = parse_heading(columns_[column].name);
    if (stated.empty()) stated = heading.unit;
    if (const auto match = match_heading(heading); stated.empty() && match) stated = match->unit;
    if (mapping.unit.empty()) return stated;
    const auto header = units::parse_length(units::without_square(stated));
    const auto wanted = units::parse_length(units::without_square(mapping.unit));
    if (header && wanted && *header != *wanted) {
      plan_.warnings.push_back("column '" + columns_[column].name + "' is in " + stated +
                               " by its header, but input.columns." + key + ".unit says " + mapping.unit +
                               ": " + mapping.unit + " is taken");
    }
    return mapping.unit;
  }

  // Where a column is called an uncertainty, one that is only called sigma is the width of the PSF.
  void prefer_uncertainties_to_widths() {
    const auto best = [&](std::initializer_list<Quantity> set) {
      Claim claim = Claim::weak;
      for (const Quantity q : set) {
        for (const Candidate& c : of(q)) claim = std::max(claim, c.claim);
      }
      return claim;
    };
    if (best({Quantity::sigma_x, Quantity::sigma_y, Quantity::sigma_lateral}) != Claim::plain) return;
    std::string widths;
    bool per_axis = false;
    for (const Quantity q :
         {Quantity::sigma_lateral, Quantity::sigma_x, Quantity::sigma_y, Quantity::sigma_z}) {
      if (q == Quantity::sigma_z && !per_axis) break;  // the only axial one beside a lateral uncertainty
      auto& list = of(q);
      for (auto c = list.begin(); c != list.end();) {
        if (c->claim == Claim::plain) {
          ++c;
          continue;
        }
        widths += (widths.empty() ? "'" : ", '") + columns_[c->column].name + "'";
        per_axis = per_axis || q == Quantity::sigma_x;
        taken_for_widths_.push_back(c->column);
        c = list.erase(c);
      }
    }
    if (!widths.empty()) {
      plan_.warnings.push_back(widths +
                               ": taken as the width of the PSF, because other columns are called "
                               "uncertainties (input.columns says otherwise)");
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
    for (const Claim claim : {Claim::likely, Claim::plain})
      keep_if_any([claim](const Candidate& c) { return c.claim >= claim; });
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
    settle_covariance();
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

  // Variances without anything off the diagonal are standard deviations squared; a covariance needs what the
  // data have: no z where there is none, and an axial variance only where z is correlated.
  void settle_covariance() {
    const bool correlated = has(Quantity::sigma_xy) || has(Quantity::sigma_xz) || has(Quantity::sigma_yz);
    const std::pair<Quantity, Quantity> diagonal[]{{Quantity::sigma_xx, Quantity::sigma_x},
                                                   {Quantity::sigma_yy, Quantity::sigma_y},
                                                   {Quantity::sigma_zz, Quantity::sigma_z}};
    for (const auto& [covariance, deviation] : diagonal) {
      const bool variance = has(deviation) && of(deviation).front().spread == Spread::variance;
      if (correlated && variance && !has(covariance)) of(covariance) = of(deviation);
      if (!correlated && has(covariance)) of(deviation) = of(covariance);
      if (!correlated) of(covariance).clear();
    }
    if (!correlated) return;
    if (!has(Quantity::sigma_xx) || !has(Quantity::sigma_yy)) {
      fail("a covariance needs sigma_xx and sigma_yy", "name them under input.columns");
    }
    if (!has(Quantity::sigma_zz) && has(Quantity::z) &&
        (has(Quantity::sigma_xz) || has(Quantity::sigma_yz))) {
      fail("a covariance of z with x or y needs sigma_zz", "name it under input.columns");
    }
    for (const Quantity q : standard_deviations) of(q).clear();
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

  // nm per unit of the column, and how people write that unit.
  std::pair<double, std::string> length_unit(Quantity q, const Candidate& candidate) {
    const SourceColumn& source = columns_[candidate.column];
    if (source.unit_nm > 0 && candidate.unit == source.unit) {
      return {source.unit_nm, source.unit_nm == 1 ? "nm" : "px = " + number_text(source.unit_nm) + " nm"};
    }
    std::string text(units::without_square(candidate.unit));
    if (text.empty()) {
      if (!options_.unit.empty()) {
        plan_.keys_used.insert("unit");
        text = options_.unit;
      } else if (is_position(q)) {
        unitless_positions_ += (unitless_positions_.empty() ? "'" : ", '") + source.name + "'";
        text = "nm";
      } else {
        unitless_uncertainties_ += (unitless_uncertainties_.empty() ? "'" : ", '") + source.name + "'";
        return position_unit_[q == Quantity::sigma_z || q == Quantity::sigma_zz ? 1 : 0];
      }
    }
    const auto unit = units::parse_length(text);
    if (!unit)
      fail("column '" + source.name + "' is in '" + text + "', which is not a length",
           "give its unit under input.columns");
    if (*unit != units::Length::pixel) return {units::to_nm(*unit, 0), std::string(units::name(*unit))};
    if (!(options_.pixel_size_nm > 0)) {
      fail("column '" + source.name + "' is in pixels and their size is not known",
           "set input.pixel_size_nm");
    }
    plan_.keys_used.insert("pixel_size_nm");
    return {options_.pixel_size_nm, "px = " + number_text(options_.pixel_size_nm) + " nm"};
  }

  // A unit with a square on a column of standard deviations says that they are variances.
  Spread spread_of(Quantity q, const Candidate& candidate) {
    const bool squared = units::without_square(candidate.unit) != candidate.unit;
    if (!is_uncertainty(q) || !squared || candidate.mapped || candidate.spread == Spread::variance)
      return candidate.spread;
    plan_.warnings.push_back("column '" + columns_[candidate.column].name +
                             "' is taken as variances, because its unit is " + candidate.unit);
    return Spread::variance;
  }

  void convert(Quantity q) {
    if (!has(q)) return;
    const Candidate& candidate = of(q).front();
    const SourceColumn& source = columns_[candidate.column];
    PlannedColumn planned{candidate.column, 1.0, spread_of(q, candidate)};
    const bool length = is_position(q) || is_uncertainty(q);
    std::string line = std::string(column_spec(q).name) + " <- '" + source.name + "'";
    if (length) {
      const auto [factor, unit] = length_unit(q, candidate);
      planned.factor = factor;
      if (q == Quantity::x) position_unit_.fill({factor, unit});
      if (q == Quantity::z) position_unit_[1] = {factor, unit};
      const bool square = planned.spread == Spread::variance;
      line += square
                  ? " (variance, " + (unit.find(' ') == std::string::npos ? unit : "(" + unit + ")") + "^2)"
                  : " (" + unit + ")";
    }
    plan_.used[static_cast<std::size_t>(q)] = planned;
    plan_.mapping.push_back(line);
    if (candidate.claim == Claim::weak) {
      plan_.warnings.push_back(
          "column '" + source.name + "' is taken as " + std::string(column_spec(q).meaning) +
          "; name the right one under input.columns." + std::string(column_spec(q).name));
    }
    if (q == Quantity::particle) {
      const bool smap = parse_heading(source.name).name.rfind("sitenumber", 0) == 0;  // SMAP: 0 is "no site"
      if (smap) plan_.unassigned_particle = {"0"};
      if (!options_.unassigned_particle.empty()) plan_.unassigned_particle = options_.unassigned_particle;
    }
  }

  void warn_about_units() {
    if (!unitless_positions_.empty()) {
      plan_.warnings.push_back(unitless_positions_ + " carry no unit: taken as nm" +
                               (options_.positions_only ? "" : " (input.unit says otherwise)"));
    }
    if (!unitless_uncertainties_.empty()) {
      plan_.warnings.push_back(unitless_uncertainties_ +
                               " carry no unit: taken in the unit of the positions");
    }
  }

  // Columns that speak of uncertainties and have no say, where the ones that are used leave something open.
  void warn_about_untaken() {
    if (options_.positions_only) return;
    const bool axial = !plan_[Quantity::z] || plan_.has_axial_uncertainty();
    if (plan_.has_uncertainty() && axial) return;
    std::string names;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const bool taken =
          std::any_of(plan_.used.begin(), plan_.used.end(),
                      [&](const auto& planned) { return planned && planned->column == i; }) ||
          std::find(taken_for_widths_.begin(), taken_for_widths_.end(), i) != taken_for_widths_.end();
      if (taken || columns_[i].quantity || !sounds_like_uncertainty(parse_heading(columns_[i].name).name))
        continue;
      names += (names.empty() ? "'" : ", '") + columns_[i].name + "'";
    }
    if (!names.empty()) {
      plan_.warnings.push_back(names +
                               ": named like an uncertainty and not used; if it is one, say so under "
                               "input.columns (sigma_x, sigma_y, sigma_z, sigma_xy)");
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
  std::vector<std::size_t> taken_for_widths_;
  std::array<std::pair<double, std::string>, 2> position_unit_;  // of x and of z
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

std::size_t find_mapped_column(const std::string& file, const std::vector<SourceColumn>& columns,
                               const std::string& key, const std::string& name) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == name) return i;
  }
  const std::string wanted = parse_heading(name).name;
  std::vector<std::size_t> similar;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (parse_heading(columns[i].name).name == wanted) similar.push_back(i);
  }
  if (similar.size() == 1) return similar.front();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error == std::errc() && end == name.data() + name.size() && number >= 1 && number <= columns.size()) {
    return number - 1;
  }
  throw Error(Fault::input, file, "has no column '" + name + "', which input.columns." + key + " names",
              "its columns are " + list_columns(columns));
}

ColumnPlan plan_columns(const std::string& file, const std::vector<SourceColumn>& columns,
                        const ReadOptions& options) {
  return Planner(file, columns, options).plan();
}

}  // namespace smlm
