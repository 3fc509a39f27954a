#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "polar/report/batch_page.hpp"
#include "polar/report/record.hpp"
#include "raster.hpp"
#include "results/csv_line.hpp"
#include "section.hpp"
#include "smlm/error.hpp"

namespace polar {

namespace {
using nlohmann::json;

constexpr std::size_t kThumbnailVoxels = 96;

std::string text(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// The average from the top. A data set that is just being written has none yet.
std::string thumbnail(const std::string& results_h5) {
  try {
    const RunRecord record = read_run_record(results_h5);
    if (accepted_particles(record) == 0) return {};
    const report::Subject subject(record);
    RenderOptions options = record.result.render;
    options.most_voxels_per_axis = kThumbnailVoxels;
    const report::Raster top = report::projected(render(subject.points, options), report::kTopView);
    return report::heat_png(top, top.largest());
  } catch (const smlm::Error&) {
    return {};
  }
}

// A folder's name within a link.
std::string url_part(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '-' || c == '_' || c == '.' || c == '~') {
      out += c;
      continue;
    }
    out += '%';
    out += "0123456789ABCDEF"[byte >> 4];
    out += "0123456789ABCDEF"[byte & 15];
  }
  return out;
}

BatchDataset dataset_of(const json& row, const std::string& folder) {
  BatchDataset d;
  d.name = text(row, "name"), d.condition = text(row, "condition");
  d.state = text(row, "state"), d.reason = text(row, "reason"), d.symmetry = text(row, "symmetry");
  for (const auto& [key, value] : row.items())
    if (value.is_number() && key != "exit_code") d.number[key] = value.get<double>();
  std::error_code unseen;  // what cannot be seen is not there
  if (std::filesystem::is_regular_file(folder + "/" + d.name + "/report.html", unseen))
    d.link = "./" + url_part(d.name) + "/report.html";
  const std::string record = folder + "/" + d.name + "/results.h5";
  if (std::filesystem::is_regular_file(record, unseen)) d.thumbnail_png = thumbnail(record);
  return d;
}

double number_of(const std::string& field) {
  try {
    return field.empty() ? std::nan("") : std::stod(field);
  } catch (const std::exception&) {
    return std::nan("");
  }
}

std::vector<BatchMean> means_of(const std::string& conditions_csv) {
  std::vector<BatchMean> means;
  std::ifstream in(conditions_csv);
  std::map<std::string, std::size_t> column;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> fields = results::split_csv(line);
    if (column.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i) column[fields[i]] = i;
      continue;
    }
    const auto field = [&](const char* name) {
      const auto found = column.find(name);
      return found != column.end() && found->second < fields.size() ? fields[found->second] : std::string();
    };
    means.push_back({field("measure"), field("condition"), field("minus"), number_of(field("mean")),
                     number_of(field("low")), number_of(field("high"))});
  }
  return means;
}
}  // namespace

BatchRecord read_batch_record(const std::string& folder) {
  const std::string path = folder + "/batch.json";
  std::ifstream in(path);
  const json batch = json::parse(in, nullptr, false);
  if (!batch.is_object() || !batch.contains("datasets") || !batch["datasets"].is_array())
    throw smlm::Error(smlm::Fault::input, path, "not the state of a batch",
                      "give the folder of a polar batch");
  BatchRecord record;
  record.program = text(batch, "program");
  for (const json& row : batch["datasets"])
    if (row.is_object()) record.datasets.push_back(dataset_of(row, folder));
  record.means = means_of(folder + "/conditions.csv");
  return record;
}

}  // namespace polar
