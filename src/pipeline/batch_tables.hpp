// summary.csv, conditions.csv and batch.json: what a batch is so far.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "polar/pipeline/batch_config.hpp"

namespace polar::pipeline {

/// A data set as the tables show it.
struct DatasetRow {
  std::string name, condition;
  std::string state;       // waiting | running | done | kept | stopped | failed
  std::string reason;      // why it failed
  int exit_code = 0;       // that `polar run` would have ended with
  nlohmann::json summary;  // its summary.json; null where it has no complete result
};

/// One line a data set.
std::string batch_summary_csv(const std::vector<DatasetRow>& rows);

/// The means of the conditions and their differences (see condition_means), a line each.
std::string batch_conditions_csv(const std::vector<DatasetRow>& rows, const BootstrapOptions& bootstrap);

/// The same rows for programs.
nlohmann::json batch_json(const std::vector<DatasetRow>& rows, const BootstrapOptions& bootstrap);

}  // namespace polar::pipeline
