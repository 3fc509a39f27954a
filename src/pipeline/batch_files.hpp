// The files that `polar batch` writes beside the folders of its data sets.
#pragma once

#include <string>

#include "polar/pipeline/outputs.hpp"

namespace polar::pipeline {

constexpr const char* kBatchSummary = "summary.csv";
constexpr const char* kBatchConditions = "conditions.csv";
constexpr const char* kBatchState = "batch.json";
constexpr const char* kBatchTasks = "tasks";  // a folder: what tasks of their own are given and leave

inline bool is_batch_file(const std::string& name) {
  return name == kBatchSummary || name == kBatchConditions || name == kBatchState || name == kBatchTasks ||
         name == kReportFile;
}

}  // namespace polar::pipeline
