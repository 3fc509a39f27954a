#include "batch_tables.hpp"

#include <cmath>
#include <limits>

#include "condition_statistics.hpp"
#include "polar/pipeline/version.hpp"
#include "results/csv_line.hpp"

namespace polar::pipeline {

namespace {
using results::csv_field;
using results::csv_number;

// A column of summary.csv and where summary.json has it.
struct Column {
  const char* name;
  const char* pointer;
};
constexpr Column kColumns[] = {{"particles", "/particles"},
                               {"accepted", "/accepted"},
                               {"localisations", "/localisations"},
                               {"resolution_nm", "/resolution/halves/resolution_nm"},
                               {"rotation_std_deg", "/precision/rotation_std_deg"},
                               {"translation_std_nm", "/precision/translation_std_nm"},
                               {"symmetry", "/symmetry/group"},
                               {"lateral_factor", "/calibration/lateral_factor"},
                               {"lateral_extra_nm", "/calibration/lateral_extra_nm"},
                               {"axial_factor", "/calibration/axial_factor"},
                               {"axial_extra_nm", "/calibration/axial_extra_nm"},
                               {"labelling_efficiency", "/labelling/efficiency"},
                               {"labelling_low", "/labelling/low"},
                               {"labelling_high", "/labelling/high"},
                               {"seconds", "/seconds"}};

nlohmann::json at(const nlohmann::json& summary, const char* pointer) {
  const nlohmann::json::json_pointer where(pointer);
  return summary.is_object() && summary.contains(where) ? summary.at(where) : nlohmann::json();
}

double number(const nlohmann::json& summary, const char* pointer) {
  const nlohmann::json value = at(summary, pointer);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string field(const nlohmann::json& value) {
  if (value.is_string()) return csv_field(value.get<std::string>());
  return value.is_number() ? csv_number(value.get<double>()) : std::string();
}

// A number that conditions are compared by.
struct Measure {
  const char* name;
  double (*of)(const nlohmann::json& summary);
};
const Measure kMeasures[] = {
    {"accepted_share",
     [](const nlohmann::json& s) { return number(s, "/accepted") / number(s, "/particles"); }},
    {"localisations_per_particle",
     [](const nlohmann::json& s) { return number(s, "/localisations") / number(s, "/particles"); }},
    {"resolution_nm", [](const nlohmann::json& s) { return number(s, "/resolution/halves/resolution_nm"); }},
    {"rotation_std_deg", [](const nlohmann::json& s) { return number(s, "/precision/rotation_std_deg"); }},
    {"translation_std_nm",
     [](const nlohmann::json& s) { return number(s, "/precision/translation_std_nm"); }},
    {"lateral_factor", [](const nlohmann::json& s) { return number(s, "/calibration/lateral_factor"); }},
    {"lateral_extra_nm", [](const nlohmann::json& s) { return number(s, "/calibration/lateral_extra_nm"); }},
    {"labelling_efficiency", [](const nlohmann::json& s) { return number(s, "/labelling/efficiency"); }}};
}  // namespace

std::string batch_summary_csv(const std::vector<DatasetRow>& rows) {
  std::string text = "name,condition";
  for (const Column& c : kColumns) text += std::string(",") + c.name;
  text += ",state,reason\n";
  for (const DatasetRow& row : rows) {
    text += csv_field(row.name) + "," + csv_field(row.condition);
    for (const Column& c : kColumns) text += "," + field(at(row.summary, c.pointer));
    text += "," + row.state + "," + csv_field(row.reason) + "\n";
  }
  return text;
}

std::string batch_conditions_csv(const std::vector<DatasetRow>& rows, const BootstrapOptions& bootstrap) {
  std::string text = "measure,condition,minus,datasets,minus_datasets,mean,low,high\n";
  std::uint64_t item = 0;
  for (const Measure& measure : kMeasures) {
    std::vector<Observation> observations;
    for (const DatasetRow& row : rows) observations.push_back({row.condition, measure.of(row.summary)});
    for (const ConditionMean& m : condition_means(observations, bootstrap, item++)) {
      const bool difference = m.other_datasets > 0;
      text += std::string(measure.name) + "," + csv_field(m.condition) + "," + csv_field(m.other) + "," +
              std::to_string(m.datasets) + "," + (difference ? std::to_string(m.other_datasets) : "");
      for (const double value : {m.mean, m.low, m.high}) text += "," + csv_number(value);
      text += "\n";
    }
  }
  return text;
}

nlohmann::json batch_json(const std::vector<DatasetRow>& rows, const BootstrapOptions& bootstrap) {
  nlohmann::json datasets = nlohmann::json::array();
  for (const DatasetRow& row : rows) {
    nlohmann::json d = {{"name", row.name},           {"condition", row.condition},
                        {"state", row.state},         {"reason", row.reason},
                        {"exit_code", row.exit_code}, {"input_hash", at(row.summary, "/input_hash")}};
    for (const Column& c : kColumns) d[c.name] = at(row.summary, c.pointer);
    datasets.push_back(std::move(d));
  }
  return {{"program", program_version()},
          {"bootstrap", {{"draws", bootstrap.draws}, {"level", bootstrap.level}, {"seed", bootstrap.seed}}},
          {"datasets", datasets}};
}

}  // namespace polar::pipeline
