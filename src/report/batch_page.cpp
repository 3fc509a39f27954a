#include "polar/report/batch_page.hpp"

#include <algorithm>
#include <cmath>

#include "base64.hpp"
#include "embedded_data.hpp"
#include "page_data.hpp"
#include "plot.hpp"
#include "polar/core/rng.hpp"
#include "smlm/atomic_file.hpp"
#include "text.hpp"

namespace polar {

namespace {
using namespace report;

constexpr std::uint32_t kJitterStage = 0xA1;
constexpr double kJitter = 0.5;  // of a condition's width

// A number that data sets are compared by: of one column, or the ratio of two.
struct Measure {
  const char *name, *title, *of, *over;
};
constexpr Measure kMeasures[] = {
    {"accepted_share", "Share of particles accepted", "accepted", "particles"},
    {"localisations_per_particle", "Localisations a particle", "localisations", "particles"},
    {"resolution_nm", "Resolution [nm]", "resolution_nm", nullptr},
    {"rotation_std_deg", "Uncertainty of a rotation [deg]", "rotation_std_deg", nullptr},
    {"translation_std_nm", "Uncertainty of a place [nm]", "translation_std_nm", nullptr},
    {"lateral_factor", "Lateral scatter, found over stated", "lateral_factor", nullptr},
    {"labelling_efficiency", "Labelling efficiency", "labelling_efficiency", nullptr}};

double value_of(const BatchDataset& d, const char* name) {
  const auto found = d.number.find(name);
  return found == d.number.end() ? std::nan("") : found->second;
}

double value_of(const BatchDataset& d, const Measure& m) {
  return m.over ? value_of(d, m.of) / value_of(d, m.over) : value_of(d, m.of);
}

std::vector<std::string> conditions_of(const BatchRecord& batch) {
  std::vector<std::string> names;
  for (const BatchDataset& d : batch.datasets)
    if (std::find(names.begin(), names.end(), d.condition) == names.end()) names.push_back(d.condition);
  return names;
}

Figure strip(const BatchRecord& batch, const std::vector<std::string>& conditions, const Measure& m,
             std::size_t index) {
  std::vector<double> x, y, all;
  for (std::size_t i = 0; i < batch.datasets.size(); ++i) {
    const BatchDataset& d = batch.datasets[i];
    const double value = value_of(d, m);
    if (!std::isfinite(value)) continue;
    const auto at = std::find(conditions.begin(), conditions.end(), d.condition) - conditions.begin();
    x.push_back(static_cast<double>(at) + kJitter * (KeyedRandom(index, i, kJitterStage).uniform() - 0.5));
    y.push_back(value);
  }
  all = y;
  if (y.empty())
    return absent(std::string("strip-") + m.name, m.title,
                  "No data set has this number yet, or none was asked for it.");
  std::vector<std::pair<double, std::string>> ticks;
  for (std::size_t c = 0; c < conditions.size(); ++c)
    ticks.emplace_back(static_cast<double>(c), conditions[c].empty() ? "(none)" : conditions[c]);
  for (const BatchMean& mean : batch.means)
    if (mean.measure == m.name && mean.minus.empty())
      for (const double v : {mean.mean, mean.low, mean.high}) all.push_back(v);
  Plot plot({-0.6, static_cast<double>(conditions.size()) - 0.4, "", ticks}, axis_of(all, ""));
  plot.dots("c1", x, y);
  bool intervals = false;
  for (const BatchMean& mean : batch.means) {
    if (mean.measure != m.name || !mean.minus.empty()) continue;
    const auto at = std::find(conditions.begin(), conditions.end(), mean.condition) - conditions.begin();
    plot.error_bar("c2", static_cast<double>(at) + 0.36, mean.low, mean.mean, mean.high);
    intervals = true;
  }
  return {std::string("strip-") + m.name, m.title,
          plot.svg(m.title + std::string(" of every data set by condition")),
          counted(y.size(), "data set") +
              (intervals ? "; beside them the mean of the condition and its bootstrap interval." : ".")};
}

// As its strip is called; what has no strip goes by its name in conditions.csv.
std::string title_of(const std::string& measure) {
  for (const Measure& m : kMeasures)
    if (measure == m.name) return m.title;
  return measure;
}

Section strips_section(const BatchRecord& batch) {
  Section s{"conditions", "Conditions", {}, {}, {}};
  const std::vector<std::string> conditions = conditions_of(batch);
  for (std::size_t k = 0; k < std::size(kMeasures); ++k)
    s.figures.push_back(strip(batch, conditions, kMeasures[k], k));
  Table differences{{"number", "condition", "minus", "difference", "from", "to"}, {}};
  for (const BatchMean& m : batch.means)
    if (!m.minus.empty())
      differences.rows.push_back({title_of(m.measure), m.condition, m.minus, digits(m.mean, 4),
                                  digits(m.low, 4), digits(m.high, 4)});
  if (!differences.rows.empty()) s.tables.push_back(differences);
  return s;
}

std::string datasets_json(const BatchRecord& batch) {
  using nlohmann::json;
  json heads = json::array(), rows = json::array();
  const auto head = [&](const char* name, bool number) {
    heads.push_back({{"name", name}, {"number", number}});
  };
  head("data set", false), head("average", false), head("condition", false), head("state", false);
  head("particles", true), head("accepted", true), head("localisations", true), head("resolution [nm]", true);
  head("place [nm]", true), head("rotation [deg]", true), head("symmetry", false), head("labelling", true);
  head("seconds", true), head("reason", false);
  const auto number = [](double v) { return rounded_json(v, 4); };
  for (const BatchDataset& d : batch.datasets) {
    json name = {{"text", d.name}};
    if (!d.link.empty()) name["link"] = d.link;
    const json picture =
        d.thumbnail_png.empty()
            ? json()
            : json({{"text", "average of " + d.name}, {"picture", png_uri(d.thumbnail_png)}});
    rows.push_back({name, picture, d.condition, d.state, number(value_of(d, "particles")),
                    number(value_of(d, "accepted")), number(value_of(d, "localisations")),
                    number(value_of(d, "resolution_nm")), number(value_of(d, "translation_std_nm")),
                    number(value_of(d, "rotation_std_deg")), d.symmetry,
                    number(value_of(d, "labelling_efficiency")), number(value_of(d, "seconds")), d.reason});
  }
  return script_json({{"heads", heads}, {"rows", rows}});
}
}  // namespace

std::string batch_page(const BatchRecord& batch, const std::string& name) {
  Data page = page_data(name, "polar batch", {strips_section(batch)});
  std::map<std::string, std::size_t> states;
  for (const BatchDataset& d : batch.datasets) ++states[d.state];
  std::string words;
  for (const auto& [state, n] : states)
    words += (words.empty() ? "" : ", ") + std::to_string(n) + " " + state;
  page.set("program", utf8(batch.program));
  page.set("sentence",
           counted(batch.datasets.size(), "data set") + (words.empty() ? "" : ": " + words) + ".");
  std::vector<std::string> failures;
  for (const BatchDataset& d : batch.datasets)
    if (!d.reason.empty()) failures.push_back(d.name + " " + d.state + ": " + d.reason);
  page.set("has_failures", !failures.empty());
  page.set("failures", text_list(failures));
  page.set("datasets", datasets_json(batch));
  page.set("script", template_text("table.js") + template_text("batch.js"));
  return filled("batch.html", page);
}

void write_batch_report(const std::string& folder, const std::string& html, const std::string& name) {
  smlm::write_file_atomically(html, batch_page(read_batch_record(folder), name));
}

}  // namespace polar
