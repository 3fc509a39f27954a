#include "dataset_end.hpp"

#include <filesystem>
#include <fstream>

#include "json_text.hpp"
#include "smlm/atomic_file.hpp"
#include "smlm/error.hpp"

namespace polar::pipeline {

namespace {
std::string path_of(const std::string& folder, const std::string& name) {
  return folder + "/" + name + ".json";
}
}  // namespace

void write_dataset_end(const std::string& folder, const std::string& name, const DatasetEnd& end) {
  std::error_code unseen;
  std::filesystem::create_directories(folder, unseen);
  try {
    smlm::write_file_atomically(
        path_of(folder, name),
        json_text({{"stopped", end.stopped}, {"exit_code", end.exit_code}, {"reason", end.reason}}));
  } catch (const smlm::Error&) {  // the data set's own fault is what is reported
  }
}

std::optional<DatasetEnd> read_dataset_end(const std::string& folder, const std::string& name) {
  std::ifstream in(path_of(folder, name));
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    return DatasetEnd{json.at("stopped").get<bool>(), json.at("exit_code").get<int>(),
                      json.at("reason").get<std::string>()};
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

void remove_dataset_end(const std::string& folder, const std::string& name) {
  std::error_code absent;
  std::filesystem::remove(path_of(folder, name), absent);
}

}  // namespace polar::pipeline
